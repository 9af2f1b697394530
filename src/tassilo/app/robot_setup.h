#pragma once

#include <string>
#include <vector>

#include "tassilo/app/written_files.h"
#include "tassilo/files/robot_file.h"
#include "tassilo/vision/vision.h"

namespace tassilo {

/// What a robot sees with, and the files that said so.
struct RobotSetup {
  VisionSetup vision;
  std::vector<NamedFile> read;
};

/// A start pose as the vision takes it.
PoseGaussian gaussian_of(const StartPose& start);

/// Reads a robot file (none when empty) and all that it names; `colors`, when given, takes the place of its color
/// table. Throws Error naming the file that is wrong, and the robot file where it names something that is not there.
RobotSetup read_robot_setup(const std::string& robot_file, const std::string& colors);

}  // namespace tassilo
