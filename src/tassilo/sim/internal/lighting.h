#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tassilo/sim/internal/ray_world.h"
#include "tassilo/sim/renderer.h"

namespace tassilo {

/// The light of lamps and of the surroundings at places and directions, and what the floor gets of it, baked.
class Lighting {
 public:
  struct Lamp {
    float x, y, z, radius;
    Light color;  ///< Times intensity.
  };

  /// Lamps of the options, or the usual ones. `world` must have no moving parts that shade.
  Lighting(const Stage& stage, const RayWorld& world, const RenderOptions& options);

  const std::vector<Lamp>& lamps() const { return lamps_; }

  /// Light from a lamp at `at`, where nothing is in the way. [of its color]
  static float share(const Lamp& lamp, const Eigen::Vector3f& at, const Eigen::Vector3f& normal) {
    const float x = lamp.x - at.x(), y = lamp.y - at.y(), z = lamp.z - at.z();
    const float facing = x * normal.x() + y * normal.y() + z * normal.z(), square = x * x + y * y + z * z;
    return facing > 0 && z > 0 ? facing / (square * std::sqrt(square)) : 0;
  }
  /// From all sides: from above, and back from the floor.
  Light ambient(const Eigen::Vector3f& normal) const {
    return .5F * (1 + normal.z()) * above_ + .5F * (1 - normal.z()) * below_;
  }
  const Light& above() const { return above_; }
  const Light& below() const { return below_; }

  /// Of all lamps and from all sides at a place of the stage's triangle, on the side that `normal` is of or on its
  /// back; without shadows.
  const Light& at_corner(std::uint32_t vertex, bool back) const { return (back ? backs_ : fronts_)[vertex]; }

  /// At the floor, with the shadows of what stands still; ambient light included.
  Light floor(float x, float y) const {
    const float column = std::clamp((x - x0_) * per_cell_, 0.F, columns_limit_);
    const float row = std::clamp((y - y0_) * per_cell_, 0.F, rows_limit_);
    const int c = static_cast<int>(column), r = static_cast<int>(row);
    const float fx = column - static_cast<float>(c), fy = row - static_cast<float>(r);
    const Light* cell = floor_.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + c;
    const Light low = cell[0] + fx * (cell[1] - cell[0]);
    const Light high = cell[columns_] + fx * (cell[columns_ + 1] - cell[columns_]);
    return low + fy * (high - low);
  }

 private:
  std::vector<Lamp> lamps_;
  Light above_, below_;
  std::vector<Light> floor_;
  std::vector<Light> fronts_, backs_;  ///< At the stage's vertices.
  int columns_ = 0, rows_ = 0;
  float x0_ = 0, y0_ = 0, per_cell_ = 1, columns_limit_ = 0, rows_limit_ = 0;
};

/// 256 points of the unit disc, evenly spread in every stretch of them.
const std::vector<std::array<float, 2>>& disc_points();

}  // namespace tassilo
