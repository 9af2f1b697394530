#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/files/robot_file.h"
#include "tassilo/team/bus.h"

namespace tassilo {

/// What the command line says of the bus.
struct BusArguments {
  std::string interface;
  std::optional<int> domain;
  std::vector<std::string> peers;
  bool multicast = false;

  void add_to(CLI::App& command);
  /// Where the command line is silent, as the robot file says; the domain then as ROS_DOMAIN_ID says.
  /// Throws Error for what is out of range.
  BusOptions options(const BusSettings& robot = {}) const;
};

}  // namespace tassilo
