#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tassilo/app/written_files.h"
#include "tassilo/files/robot_file.h"
#include "tassilo/files/start_state_file.h"
#include "tassilo/vision/vision.h"

namespace tassilo {

/// The roles of a color table and of a camera file among the files that were read.
inline constexpr const char* kColorsRole = "color table";
inline constexpr const char* kCameraRole = "camera file";

/// What a robot sees with, and the files that said so.
struct RobotSetup {
  VisionSetup vision;
  StageRegistry registry;                                 ///< What the vision chooses its stages from.
  RobotFile robot;                                        ///< What the robot file says.
  std::optional<StartState> start_state;                  ///< Of a recording: what was known before its first frame.
  std::vector<std::pair<std::string, Setting>> settings;  ///< Below `vision:`, as written.
  std::vector<std::pair<std::string, Setting>> at_work;   ///< The same with what was changed while running.
  std::vector<NamedFile> read;
};

/// A start pose as the vision takes it.
PoseGaussian gaussian_of(const StartPose& start);

/// The built-in alternatives, those of the robot's plug-ins and then those of `plugins`. Throws Error naming the
/// library that is wrong, and `robot_file` where that names one that is not there.
StageRegistry registry_of(const RobotFile& robot, const std::string& robot_file, std::span<const std::string> plugins);

/// Reads a robot file (none when empty) and all that it names; `colors`, when given, takes the place of its color
/// table; `plugins` come after its own. Throws Error naming the file that is wrong, and the robot file where it names
/// something that is not there.
RobotSetup read_robot_setup(const std::string& robot_file, const std::string& colors,
                            std::span<const std::string> plugins = {});

/// Do both see the same, with the same settings below `vision:`, whatever files that comes from? Never with plug-ins,
/// whose code may have changed.
bool see_alike(const RobotSetup& a, const RobotSetup& b);

}  // namespace tassilo
