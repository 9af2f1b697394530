#include "tassilo/camera/mount.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

void check_finite(const char* field, double value) {
  if (!std::isfinite(value)) throw Error(field, "is " + std::to_string(value) + ", must be finite");
}
void check_angle(const char* field, double value) {
  if (!(std::abs(value) <= std::numbers::pi))
    throw Error(field, "is " + std::to_string(value) + " rad, must be within -pi and pi");
}

}  // namespace

void CameraMount::check() const {
  check_finite("x", x);
  check_finite("y", y);
  if (!(std::isfinite(z) && z > 0)) throw Error("z", "is " + std::to_string(z) + " m, must be > 0, above the floor");
  check_angle("roll", roll);
  check_angle("pitch", pitch);
  check_angle("yaw", yaw);
}

MountedCamera::MountedCamera(CameraModel model, CameraMount mount) : model_(std::move(model)), mount_(mount) {
  const double cr = std::cos(mount.roll), sr = std::sin(mount.roll);
  const double cp = std::cos(mount.pitch), sp = std::sin(mount.pitch);
  const double cy = std::cos(mount.yaw), sy = std::sin(mount.yaw);
  const double r[3][3] = {{cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr},
                          {sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr},
                          {-sp, cp * sr, cp * cr}};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) r_[i][k] = r[i][k];
}

RobotPoint MountedCamera::robot_from_optical(OpticalPoint direction) const {
  const double body[3] = {direction.z, -direction.x, -direction.y};
  const auto row = [&](const double(&r)[3]) { return r[0] * body[0] + r[1] * body[1] + r[2] * body[2]; };
  return {row(r_[0]), row(r_[1]), row(r_[2])};
}

OpticalPoint MountedCamera::optical_from_robot(RobotPoint d) const {
  const auto column = [&](int k) { return r_[0][k] * d.x + r_[1][k] * d.y + r_[2][k] * d.z; };
  return {-column(1), -column(2), column(0)};
}

std::optional<PixelPoint> MountedCamera::project(RobotPoint point) const {
  return tassilo::project(model_, optical_from_robot(point - center()));
}

std::optional<RobotPoint> MountedCamera::ray(PixelPoint pixel) const {
  const auto direction = unproject(model_, pixel);
  if (!direction) return std::nullopt;
  return robot_from_optical(*direction);
}

std::optional<FloorPoint> MountedCamera::floor_point(PixelPoint pixel, double height, double max_range) const {
  const auto direction = ray(pixel);
  return direction ? floor_along(*direction, height, max_range) : std::nullopt;
}

std::optional<FloorPoint> MountedCamera::floor_along(RobotPoint direction, double height, double max_range) const {
  const double reach = (height - mount_.z) / direction.z;
  const FloorPoint from_foot{reach * direction.x, reach * direction.y};
  if (!(reach > 0 && dot(from_foot, from_foot) <= max_range * max_range)) return std::nullopt;
  return FloorPoint{mount_.x, mount_.y} + from_foot;
}

std::optional<FloorPoint> floor_point_moved(const CameraMount& from, const CameraMount& to, FloorPoint at) {
  const MountedCamera before({}, from), after({}, to);
  const RobotPoint ray = RobotPoint{at.x, at.y, 0} - before.center();
  constexpr double furthest = 1000;  // [m] as good as level
  return after.floor_along(after.robot_from_optical(before.optical_from_robot(ray)), 0, furthest);
}

double floor_shift(const CameraMount& from, const CameraMount& to, double range) {
  double most = 0;
  for (const double side : {-1., 0., 1.}) {
    const double bearing = from.yaw + side * std::numbers::pi / 6;
    const FloorPoint at{from.x + range * std::cos(bearing), from.y + range * std::sin(bearing)};
    const auto moved = floor_point_moved(from, to, at);
    if (!moved) return std::numeric_limits<double>::infinity();
    most = std::max(most, distance(at, *moved));
  }
  return most;
}

}  // namespace tassilo
