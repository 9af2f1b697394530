#include "tassilo/camera/ground_map.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace tassilo {

GroundMap::GroundMap(const MountedCamera& camera, double max_range)
    : width_(camera.model().width), height_(camera.model().height) {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  cells_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      const auto point = camera.floor_point({static_cast<double>(column), static_cast<double>(row)}, 0, max_range);
      cells_.push_back(point ? Cell{static_cast<float>(point->x), static_cast<float>(point->y)} : Cell{none, none});
    }
  }
}

// The floor point is P = C + s d with the ray's direction d and s = (height - C.z) / d.z. A change of d moves it by
// s (d_xy' - d_xy d_z' / d_z); a small turn about an axis a changes d by a x d.
std::optional<Gaussian2<RobotFrame>> floor_gaussian(const MountedCamera& camera, PixelPoint pixel, double pixel_sigma,
                                                    const MountSigma& mount_sigma, double height) {
  constexpr double step = 1e-3;  // [px]; error of a central difference far below its own rounding, for any lens
  const auto mean = camera.floor_point(pixel, height);
  const auto direction = camera.ray(pixel);
  const auto right = camera.ray({pixel.x + step, pixel.y}), left = camera.ray({pixel.x - step, pixel.y});
  const auto below = camera.ray({pixel.x, pixel.y + step}), above = camera.ray({pixel.x, pixel.y - step});
  if (!mean || !direction || !right || !left || !below || !above) return std::nullopt;

  const RobotPoint d = *direction;
  const CameraMount& mount = camera.mount();
  const double reach = (height - mount.z) / d.z;
  const auto moved = [&](RobotPoint change) -> Eigen::Vector2d {
    return {reach * (change.x - d.x * change.z / d.z), reach * (change.y - d.y * change.z / d.z)};
  };
  const RobotPoint roll_axis = camera.robot_from_optical({0, 0, 1});
  const RobotPoint pitch_axis{-std::sin(mount.yaw), std::cos(mount.yaw), 0};
  const RobotPoint yaw_axis{0, 0, 1};

  Eigen::Matrix<double, 2, 8> spread;  // one column an independent source: its derivative times its standard deviation
  spread.col(0) = pixel_sigma / (2 * step) * moved(*right - *left);
  spread.col(1) = pixel_sigma / (2 * step) * moved(*below - *above);
  spread.col(2) = mount_sigma.x * Eigen::Vector2d(1, 0);
  spread.col(3) = mount_sigma.y * Eigen::Vector2d(0, 1);
  spread.col(4) = mount_sigma.z * Eigen::Vector2d(-d.x / d.z, -d.y / d.z);
  spread.col(5) = mount_sigma.roll * moved(cross(roll_axis, d));
  spread.col(6) = mount_sigma.pitch * moved(cross(pitch_axis, d));
  spread.col(7) = mount_sigma.yaw * moved(cross(yaw_axis, d));
  Gaussian2<RobotFrame> out{*mean, spread * spread.transpose()};
  out.covariance(1, 0) = out.covariance(0, 1);
  return out;
}

}  // namespace tassilo
