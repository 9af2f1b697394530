#include "tassilo/timeline/odometry.h"

#include <cmath>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {

OdometryPose Interpolation<OdometryPose>::between(const OdometryPose& a, const OdometryPose& b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.theta + share * wrap_angle(b.theta - a.theta)};
}

Odometry::Odometry(std::size_t capacity) : poses_(capacity) {
  expects(capacity >= 2, "Odometry: a capacity of at least 2");
}

Added Odometry::add(const OdometrySample& sample) {
  for (const double value : {sample.t, sample.x, sample.y, sample.theta})
    if (!std::isfinite(value)) throw Error("odometry", "a value is not finite");
  return poses_.add(sample.t, {sample.x, sample.y, sample.theta});
}

std::optional<OdometrySample> Odometry::at(double t) const {
  const std::optional<OdometryPose> pose = poses_.at(t);
  if (!pose) return std::nullopt;
  return OdometrySample{t, pose->x, pose->y, wrap_angle(pose->theta)};
}

}  // namespace tassilo
