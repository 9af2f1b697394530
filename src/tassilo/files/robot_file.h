#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tassilo/files/setting.h"
#include "tassilo/scene/scene.h"

namespace tassilo {

/// Where the robot stands at the start, field frame, with one standard deviation each.
struct StartPose {
  double x = 0, y = 0, theta = 0;            ///< [m, rad]
  double sigma_xy = 0.1, sigma_theta = 0.1;  ///< [m, rad], > 0
};

/// How a robot speaks on the team bus; what is missing is as the bus's own options have it.
struct BusSettings {
  std::optional<int> domain;             ///< 0..232
  std::optional<std::string> interface;  ///< Name or address.
  std::vector<std::string> peers;
  bool multicast = false;
  bool reliable = false;  ///< What is lost is sent again.
  std::optional<double> bytes_per_second, picture_rate;
  std::map<std::string, double, std::less<>> rates;  ///< By topic. [1/s], > 0
  friend bool operator==(const BusSettings&, const BusSettings&) = default;
};

/// What robot.yaml says; every key is optional. Paths are resolved: relative ones are relative to the file.
struct RobotFile {
  int id = 0;                                   ///< 0..255
  Team team = Team::unknown;                    ///< Our own color.
  std::optional<std::filesystem::path> camera;  ///< Without it, everything stays in the image.
  std::optional<std::filesystem::path> colors;
  std::optional<std::string> field;  ///< A shipped name or a resolved path, as read_field takes it.
  std::optional<StartPose> start_pose;
  std::optional<std::filesystem::path> start_state;  ///< What was known before the first frame; see start_state_file.h.
  BusSettings bus;
  std::vector<std::filesystem::path> plugins;  ///< Shared libraries that bring alternatives for stages.
  /// The keys below `vision:` in their order, for whoever knows what they mean.
  std::vector<std::pair<std::string, Setting>> vision;
};

/// Does not open the files it names. Throws Error with file, line and column.
RobotFile read_robot(const std::filesystem::path& file);
RobotFile robot_from_yaml(std::string_view text, const std::filesystem::path& file);
/// The text of such a file in `folder`, paths relative to it where they can be; reading it gives the same robot.
std::string robot_yaml(const RobotFile& robot, const std::filesystem::path& folder);

}  // namespace tassilo
