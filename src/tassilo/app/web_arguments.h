#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tassilo/web/server.h"

namespace tassilo {

/// What the command line says of a server for browsers.
struct WebArguments {
  WebOptions web;
  std::string pages;

  void add_to(CLI::App& command);
  /// With the folder of pages that is there, and with a token where one is needed.
  WebOptions options() const;
};

/// Prints where to look, with a QR code for phones where others can reach it.
void tell_address(const WebOptions& web, const std::string& url);

}  // namespace tassilo
