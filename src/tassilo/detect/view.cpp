#include "tassilo/detect/view.h"

#include <algorithm>
#include <cmath>

namespace tassilo {

namespace {

/// Less horizontal than this a direction has no heading worth the name.
constexpr double kLeastFlat = 1e-6;

}  // namespace

ClassBits robot_colors(const FieldModel::Robots& robots) {
  ClassBits colors = class_bit(color_class_from(robots.body).value_or(ColorClass::no_color));
  for (const std::string& marker : robots.markers)
    colors |= class_bit(color_class_from(marker).value_or(ColorClass::no_color));
  return colors;
}

std::optional<GridPoint> pixel_of(const View& view, PixelPoint place) {
  const double width = view.segmentation.width, height = view.segmentation.height;
  if (!(place.x > -0.5 && place.x < width - 0.5 && place.y > -0.5 && place.y < height - 0.5)) return std::nullopt;
  return GridPoint{static_cast<int>(std::lround(place.x)), static_cast<int>(std::lround(place.y))};
}

std::optional<FloorPoint> floor_at_range(const MountedCamera& camera, PixelPoint pixel, double range) {
  const auto ray = camera.ray(pixel);
  if (!ray) return std::nullopt;
  const double flat = std::hypot(ray->x, ray->y);
  if (flat < kLeastFlat) return std::nullopt;
  return FloorPoint{camera.center().x + range * ray->x / flat, camera.center().y + range * ray->y / flat};
}

std::optional<double> height_at_range(const MountedCamera& camera, PixelPoint pixel, double range) {
  const auto ray = camera.ray(pixel);
  if (!ray) return std::nullopt;
  const double flat = std::hypot(ray->x, ray->y);
  if (flat < kLeastFlat) return std::nullopt;
  return camera.center().z + range * ray->z / flat;
}

double longest_distance(const FieldModel& field) {
  double length = field.length, width = field.width;
  if (field.walls) {
    length = std::max(length, field.walls->x.high - field.walls->x.low);
    width = std::max(width, field.walls->y.high - field.walls->y.low);
  }
  double depth = 0;
  for (const auto& goal : field.goals) depth = std::max(depth, goal.depth);
  return std::hypot(length + 2 * depth, width);
}

}  // namespace tassilo
