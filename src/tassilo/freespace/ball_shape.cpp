#include "tassilo/freespace/internal/ball_shape.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "tassilo/geometry/point.h"

namespace tassilo {
namespace {

/// What the image shows of two directions across the ray of a pixel, at right angles. [px/rad]
std::optional<std::pair<PixelPoint, PixelPoint>> pixels_across(const MountedCamera& camera, PixelPoint pixel) {
  const auto ray = camera.ray(pixel);
  if (!ray) return std::nullopt;
  const RobotPoint other = std::abs(ray->z) < .9 ? RobotPoint{0, 0, 1} : RobotPoint{1, 0, 0};
  const RobotPoint across = normalized(cross(*ray, other)), up = cross(*ray, across);
  constexpr double kStep = 1e-3;  // well below a pixel, well above rounding [rad]
  const auto a = camera.project(camera.center() + *ray + kStep * across);
  const auto b = camera.project(camera.center() + *ray + kStep * up);
  if (!a || !b) return std::nullopt;
  return std::pair{1 / kStep * (*a - pixel), 1 / kStep * (*b - pixel)};
}

}  // namespace

BallShape::BallShape(const MountedCamera& camera, const Ball& ball)
    : center_(ball.center), farthest_(ball.radius_px), to_unit_{1 / ball.radius_px, 0, 0, 1 / ball.radius_px} {
  const auto across = pixels_across(camera, ball.center);
  if (!across) return;
  const auto& [a, b] = *across;
  const double determinant = cross(a, b);
  if (std::abs(determinant) < 1e-9) return;  // a lens that shows nothing of one direction
  // The radius in the image is the mean over all directions around the sphere.
  constexpr int kDirections = 8;  // of half a turn; the other half is the same
  double mean = 0;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = std::numbers::pi * k / kDirections;
    mean += norm(std::cos(angle) * a + std::sin(angle) * b) / kDirections;
  }
  const double scale = mean / (ball.radius_px * determinant);
  farthest_ = ball.radius_px / mean * std::sqrt(dot(a, a) + dot(b, b));
  to_unit_ = {scale * b.y, -scale * b.x, -scale * a.y, scale * a.x};
}

bool BallShape::covers(PixelPoint pixel, double rim) const {
  const PixelPoint off = pixel - center_;
  const double reach = farthest_ + rim;
  if (dot(off, off) > reach * reach) return false;  // most pixels, without a root
  const double away = norm(off);
  if (away <= rim) return true;
  const PixelPoint unit{to_unit_[0] * off.x + to_unit_[1] * off.y, to_unit_[2] * off.x + to_unit_[3] * off.y};
  return norm(unit) * (away - rim) <= away;
}

}  // namespace tassilo
