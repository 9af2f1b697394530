#pragma once

#include <cmath>
#include <numbers>

#include "tassilo/camera/test_world.h"
#include "tassilo/scene/scene.h"

namespace tassilo::test {

/// A ball of which all is known.
struct KnownBall {
  RobotPoint center;
  double radius = .1;

  bool shows_at(const MountedCamera& camera, PixelPoint pixel) const {
    const auto ray = camera.ray(pixel);
    if (!ray) return false;
    const RobotPoint to = center - camera.center();
    const double along = dot(to, *ray);
    return along > 0 && dot(to, to) - along * along < radius * radius;
  }

  /// Centre and mean radius as a detector reports them.
  Ball seen(const MountedCamera& camera) const {
    const RobotPoint to = center - camera.center();
    const RobotPoint ahead = normalized(to), across = normalized(cross(ahead, RobotPoint{0, 0, 1})),
                     up = cross(ahead, across);
    Ball ball;
    ball.center = camera.project(center).value();
    const double spread = std::tan(std::asin(radius / norm(to)));
    constexpr int kRim = 48;
    for (int k = 0; k < kRim; ++k) {
      const double angle = 2 * std::numbers::pi * k / kRim;
      const RobotPoint rim = ahead + spread * (std::cos(angle) * across + std::sin(angle) * up);
      ball.radius_px += distance(camera.project(camera.center() + rim).value(), ball.center) / kRim;
    }
    return ball;
  }
};

/// One with rows half as dense as columns, as some cameras deliver a single field of an interlaced frame.
inline MountedCamera camera_of_flat_pixels() {
  const MountedCamera square = cameras()[0];
  CameraModel model = square.model();
  model.height /= 2;
  model.fy /= 2;
  model.cy /= 2;
  return {model, square.mount()};
}

}  // namespace tassilo::test
