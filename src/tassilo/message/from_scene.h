#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/message/topics.h"
#include "tassilo/scene/scene.h"
#include "tassilo/timeline/odometry.h"
#include "tassilo/timeline/robot_motion.h"

// What was seen, as ROS 2 messages. Frames are named after REP-105: "map" is the field, "robot3/odom" the odometry's
// frame, "robot3/base_link" the robot, "robot3/free_space" the floor point its free space is measured from.

namespace tassilo {

/// Nearest nanosecond; t >= 0, before the year 2038. [s since the UNIX epoch]
ros::Time ros_time(double t);
double seconds_of(const ros::Time& time);
std::int64_t nanoseconds_of(const ros::Time& time);

/// About the vertical. [rad]
ros::Quaternion quaternion_of(double theta);
/// Of a rotation about the vertical; the heading of any other. In [-pi, pi]. [rad]
double heading_of(const ros::Quaternion& rotation);

/// "robot3/base_link" for "base_link".
std::string robot_frame_id(int robot, std::string_view frame);

/// Who tells, and what the messages need to know beyond the scene.
struct MessageContext {
  int robot = 0;  ///< 0..255
  Team team = Team::unknown;
  double ball_radius = 0.105;   ///< Height of a ball's centre above the floor. [m], > 0
  bool has_odometry = false;    ///< If only at other times than the scene's.
  double free_space_range = 8;  ///< The furthest that was asked for. [m], > 0
  MotionOptions motion = {};    ///< How sure odometry is.
};

/// The scene's time on the UNIX clock.
ros::PoseWithCovarianceStamped pose_message(const PoseSeen& pose, ros::Time stamp);
/// Infinite only where the floor is free to the maximal range: NaN where it was not seen, or seen to be free for a
/// shorter stretch, since a costmap clears whatever lies before an infinite range.
ros::LaserScan scan_message(const FreeSpace& space, ros::Time stamp, const MessageContext& context);
msgs::FreeSpace free_space_message(const FreeSpace& space, ros::Time stamp, const MessageContext& context);
/// Balls, goals and robots without floor values are left out: nobody else knows this camera's pixels.
msgs::BallArray balls_message(const Scene& scene, ros::Time stamp, const MessageContext& context);
msgs::GoalArray goals_message(const Scene& scene, ros::Time stamp, const MessageContext& context);
msgs::RobotArray robots_message(const Scene& scene, ros::Time stamp, const MessageContext& context);
msgs::LineArray lines_message(const Scene& scene, ros::Time stamp, const MessageContext& context);
msgs::TrackArray tracks_message(const Scene& scene, ros::Time stamp, const MessageContext& context);
/// Pose at the scene's time, and velocity over the tenth of a second before it; nothing where odometry does not know
/// the scene's time. The pose's covariance is left 0, which is "unknown" to ROS: it grows without bound.
std::optional<ros::Odometry> odometry_message(const Odometry& odometry, double t, ros::Time stamp,
                                              const MessageContext& context);
/// The robot in "map", through "robot3/odom" where there is odometry, and the origin of its free space.
ros::TFMessage transforms_message(const Scene& scene, const std::optional<OdometrySample>& odometry, ros::Time stamp,
                                  const MessageContext& context);
/// Kind and age of the pose, and what is known of sender and team; the rest is for whoever sends.
msgs::TeamState team_state_message(const Scene& scene, ros::Time stamp, const MessageContext& context);

}  // namespace tassilo
