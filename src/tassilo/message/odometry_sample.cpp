#include "tassilo/message/odometry_sample.h"

#include <cmath>

#include "tassilo/message/from_scene.h"

namespace tassilo {

std::string unusable(const ros::Odometry& message) {
  const ros::Time& stamp = message.header.stamp;
  if (stamp.sec < 0 || stamp.nanosec >= 1'000'000'000) return "its stamp is no time";
  constexpr double farthest = 1e6;  // [m]
  const ros::Point& at = message.pose.pose.position;
  if (!(std::abs(at.x) <= farthest) || !(std::abs(at.y) <= farthest)) return "its position is out of range";
  const ros::Quaternion& q = message.pose.pose.orientation;
  const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  constexpr double rounding = 1e-2;
  if (!(std::abs(square - 1) <= rounding)) return "its orientation is no rotation";
  return {};
}

OdometrySample odometry_sample_from(const ros::Odometry& message) {
  const ros::Pose& pose = message.pose.pose;
  return {seconds_of(message.header.stamp), pose.position.x, pose.position.y, heading_of(pose.orientation)};
}

}  // namespace tassilo
