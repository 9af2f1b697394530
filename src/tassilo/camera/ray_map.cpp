#include "tassilo/camera/ray_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tassilo {
namespace {

constexpr int kStep = 2;  // [px]

/// Enough nodes to have one at or behind the last pixel; two at least, to interpolate between.
int nodes_for(int pixels) { return std::max(2, (pixels - 1 + kStep - 1) / kStep + 1); }

}  // namespace

RayMap::RayMap(const CameraModel& camera)
    : camera_(camera), columns_(nodes_for(camera.width)), rows_(nodes_for(camera.height)) {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  nodes_.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const auto direction = unproject(camera, {double{kStep} * column, double{kStep} * row});
      nodes_.push_back(direction ? Node{static_cast<float>(direction->x), static_cast<float>(direction->y),
                                        static_cast<float>(direction->z)}
                                 : Node{none, none, none});
    }
}

std::optional<OpticalPoint> RayMap::at(PixelPoint pixel) const {
  if (!(pixel.x >= -0.5 && pixel.y >= -0.5 && pixel.x <= camera_.width - 0.5 && pixel.y <= camera_.height - 0.5))
    return unproject(camera_, pixel);
  // In the half pixel before the first node and behind the last pixel the nearest cell is continued.
  const double c = pixel.x / kStep, r = pixel.y / kStep;
  const int column = std::clamp(static_cast<int>(c), 0, columns_ - 2),
            row = std::clamp(static_cast<int>(r), 0, rows_ - 2);
  const double right = c - column, below = r - row;
  const Node* upper = nodes_.data() + static_cast<std::ptrdiff_t>(row) * columns_ + column;
  const Node* lower = upper + columns_;
  const auto mean = [&](float Node::*axis) {
    const double above = (1 - right) * upper[0].*axis + right * upper[1].*axis;
    return (1 - below) * above + below * ((1 - right) * lower[0].*axis + right * lower[1].*axis);
  };
  const OpticalPoint direction{mean(&Node::x), mean(&Node::y), mean(&Node::z)};
  const double length = norm(direction);
  if (!(length > 0)) return unproject(camera_, pixel);  // a node has no direction
  return (1 / length) * direction;
}

}  // namespace tassilo
