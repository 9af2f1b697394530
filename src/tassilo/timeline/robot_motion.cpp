#include "tassilo/timeline/robot_motion.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "tassilo/base/option_check.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {

void MotionOptions::check() const {
  const auto sigma = [](const std::string& name, double value, bool may_be_zero) {
    (may_be_zero ? check_at_least : check_above)("motion." + name, value, 0);
    check_finite("motion." + name, value);
  };
  sigma("odometry_distance_sigma", odometry_distance_sigma, true);
  sigma("odometry_turn_sigma", odometry_turn_sigma, true);
  sigma("odometry_drift_sigma", odometry_drift_sigma, false);
  sigma("speed_sigma", speed_sigma, false);
  sigma("turn_rate_sigma", turn_rate_sigma, false);
}

RobotMotion robot_motion(const Odometry* odometry, double from, double to, const MotionOptions& options) {
  RobotMotion motion;
  const double dt = std::max(to - from, 0.);
  const auto before = odometry != nullptr ? odometry->at(from) : std::nullopt;
  const auto after = odometry != nullptr ? odometry->at(to) : std::nullopt;
  if (!before || !after) {
    motion.is_measured = false;
    const double place = options.speed_sigma * dt, turn = options.turn_rate_sigma * dt;
    motion.covariance = Eigen::Vector3d(place * place, place * place, turn * turn).asDiagonal();
    return motion;
  }
  const double c = std::cos(before->theta), s = std::sin(before->theta);
  const double dx = after->x - before->x, dy = after->y - before->y;
  motion.x = c * dx + s * dy;
  motion.y = -s * dx + c * dy;
  motion.theta = wrap_angle(after->theta - before->theta);
  const double driven = std::hypot(dx, dy), turned = std::abs(motion.theta);
  const double drift = options.odometry_drift_sigma * options.odometry_drift_sigma * dt;
  const double place = options.odometry_distance_sigma * driven, turn = options.odometry_turn_sigma * turned;
  motion.covariance = Eigen::Vector3d(place * place + drift, place * place + drift, turn * turn + drift).asDiagonal();
  return motion;
}

}  // namespace tassilo
