#include "tassilo/overlay/internal/floor_view.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tassilo {
namespace {

constexpr int kRadialSteps = 24;
constexpr double kAngleStep = .035;  // about 2 degrees: edges are straight on the floor, not in the image [rad]
constexpr double kFarOff = 1e5;      // beyond, a point is of no use for drawing [px]

class SpaceProjector {
 public:
  SpaceProjector(const FreeSpace& space, const MountedCamera& camera, double scale)
      : space_(space), camera_(camera), scale_(scale) {}

  std::optional<CanvasPoint> at(double radius, double angle) const {
    const FloorPoint p = space_.origin + FloorPoint{radius * std::cos(angle), radius * std::sin(angle)};
    const auto pixel = camera_.project({p.x, p.y, 0});
    if (!pixel || std::abs(pixel->x) > kFarOff || std::abs(pixel->y) > kFarOff) return std::nullopt;
    return on_canvas(*pixel, scale_);
  }

  /// Points from near to far, denser near the camera, where the image is steeper; without those that do not show.
  std::vector<CanvasPoint> spoke(double range, double angle) const {
    std::vector<CanvasPoint> points;
    for (int i = 0; i <= kRadialSteps; ++i) {
      const double fraction = static_cast<double>(i) / kRadialSteps;
      if (const auto point = at(range * fraction * fraction, angle)) points.push_back(*point);
    }
    return points;
  }

 private:
  const FreeSpace& space_;
  const MountedCamera& camera_;
  double scale_;
};

}  // namespace

FreeSpaceInImage project_free_space(const FreeSpace& space, const MountedCamera& camera, double scale) {
  const SpaceProjector projector(space, camera, scale);
  const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(space.angle_increment) / kAngleStep)));
  FreeSpaceInImage result;
  for (std::size_t k = 0; k < space.states.size(); ++k) {
    if (space.states[k] == SectorState::unseen || !(space.ranges[k] > 0)) continue;
    const double first = space.angle_min + (static_cast<double>(k) - .5) * space.angle_increment;
    std::vector<CanvasPoint> near, far, polygon;
    for (int i = 0; i <= steps; ++i) {
      const std::vector<CanvasPoint> spoke =
          projector.spoke(space.ranges[k], first + space.angle_increment * i / steps);
      if (spoke.empty()) continue;
      near.push_back(spoke.front());
      far.push_back(spoke.back());
      if (i == 0) polygon.assign(spoke.begin(), spoke.end() - 1);
      if (i == steps) {
        polygon.insert(polygon.end(), far.begin(), far.end());
        polygon.insert(polygon.end(), spoke.rbegin() + 1, spoke.rend());
      }
    }
    if (polygon.empty()) polygon = far;
    polygon.insert(polygon.end(), near.rbegin(), near.rend());
    if (far.empty()) continue;
    result.floor.push_back(std::move(polygon));
    (space.states[k] == SectorState::blocked ? result.blocked : result.open).push_back(std::move(far));
  }
  return result;
}

}  // namespace tassilo
