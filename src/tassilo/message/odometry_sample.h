#pragma once

#include <string>

#include "tassilo/message/ros_messages.h"
#include "tassilo/timeline/odometry.h"

namespace tassilo {

/// Why a message of a robot's own odometry is of no use; empty when it is: a time, finite places within 1000 km, and a
/// rotation. Frames are not looked at, nor is the velocity, which nobody reads.
std::string unusable(const ros::Odometry& message);

/// Pose in the odometry frame at the time of its stamp; of a usable message.
OdometrySample odometry_sample_from(const ros::Odometry& message);

}  // namespace tassilo
