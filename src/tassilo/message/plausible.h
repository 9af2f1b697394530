#pragma once

#include <string>

#include "tassilo/message/ros_messages.h"
#include "tassilo/message/tassilo_messages.h"

// Whoever can reach the bus can send anything. What is taken further has been looked at here.

namespace tassilo {

/// Why a message of a robot is not to be believed; empty when it may be: finite where it must be, within a hall of
/// 100 m, covariances whose values are pairwise possible, as many things as fit on a field, text that can be shown, in
/// the frame of this robot. Its time is judged by whoever knows what time it is.
///
/// cost  O(size); safe from any thread
std::string implausible(const ros::PoseWithCovarianceStamped& message, int robot);
std::string implausible(const ros::Odometry& message, int robot);
std::string implausible(const msgs::FreeSpace& message, int robot);
std::string implausible(const msgs::BallArray& message, int robot);
std::string implausible(const msgs::RobotArray& message, int robot);
std::string implausible(const msgs::GoalArray& message, int robot);
std::string implausible(const msgs::LineArray& message, int robot);
std::string implausible(const msgs::TrackArray& message, int robot);
std::string implausible(const msgs::TeamState& message, int robot);
std::string implausible(const ros::CompressedImage& message, int robot);

}  // namespace tassilo
