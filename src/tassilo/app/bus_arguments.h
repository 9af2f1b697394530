#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/team/bus.h"

namespace tassilo {

/// What the command line says of the bus, and ROS 2's own variable of the environment.
struct BusArguments {
  std::string interface = "lo";
  std::optional<int> domain;  ///< Nothing: ROS_DOMAIN_ID, else 0.
  std::vector<std::string> peers;
  bool multicast = false;

  /// Adds the options, which all go together.
  void add_to(CLI::App& command);
  /// With room for an image without compression. Throws Error when one of them cannot be.
  BusOptions options() const;
};

}  // namespace tassilo
