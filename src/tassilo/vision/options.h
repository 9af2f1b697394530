#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tassilo/detect/ball.h"
#include "tassilo/detect/goal.h"
#include "tassilo/detect/line.h"
#include "tassilo/detect/robot.h"
#include "tassilo/files/setting.h"
#include "tassilo/freespace/free_space.h"
#include "tassilo/localize/boundary.h"
#include "tassilo/localize/localize.h"
#include "tassilo/surface/surface.h"
#include "tassilo/timeline/robot_motion.h"
#include "tassilo/track/tracks.h"

namespace tassilo {

/// Options of all stages. Keys of `vision:` in robot.yaml; to add one, add a row to the table in options.cpp.
struct VisionOptions {
  SurfaceOptions surface;  ///< line_width is taken from the field where that says one.
  BallOptions ball;
  GoalOptions goal;
  RobotOptions robot;
  LineOptions line;
  FreeSpaceOptions free_space;
  BoundaryOptions boundary;
  MotionOptions motion;
  LocalizeOptions localize;
  TrackOptions track;
  /// How well the mount is known: what a careful calibration leaves, plus how much the robot shakes and nods while
  /// driving.
  double mount_angle_sigma = 0.0002;   ///< Of roll, pitch and yaw each. [rad]
  double mount_height_sigma = 0.0005;  ///< [m]

  /// Which alternative of a stage: stage -> name; a missing stage takes its first.
  std::map<std::string, std::string, std::less<>> stages;
  /// Options that alternatives of shared libraries read: key -> value, all that are registered.
  std::map<std::string, double, std::less<>> own;

  MountSigma mount_sigma() const;
  void check() const;  ///< Throws Error naming the first option out of range.
};

/// What people may want to know of an option.
struct OptionInfo {
  std::string key;  ///< As in robot.yaml.
  std::string unit;
  double low = 0, high = 0;  ///< Closed range.
  bool whole = false;        ///< Whole numbers only.
  std::string meaning;
  double standard = 0;  ///< Value when the key is missing.
  std::string stage;    ///< That reads it.
};
/// The options of all stages, without those that single alternatives bring along.
std::vector<OptionInfo> vision_option_infos();
/// The value of each option, by its key; those of single alternatives, too.
std::map<std::string, double, std::less<>> option_values(VisionOptions options);

struct StageRegistry;
/// Options from the keys below `vision:`, and the names of stages. Throws Error with file, line and column for an
/// unknown key, a bad value, or a name that the registry does not have.
VisionOptions vision_options(std::span<const std::pair<std::string, Setting>> settings, const StageRegistry& registry);
/// With the alternatives that Tassilo comes with.
VisionOptions vision_options(std::span<const std::pair<std::string, Setting>> settings);

}  // namespace tassilo
