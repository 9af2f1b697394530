#include "tassilo/region/affine.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tassilo/base/contract.h"
#include "tassilo/region/outline.h"

namespace tassilo {

AffineMap operator*(const AffineMap& outer, const AffineMap& inner) {
  const PixelPoint origin = outer * PixelPoint{inner.x0, inner.y0};
  return {.xx = outer.xx * inner.xx + outer.xy * inner.yx,
          .xy = outer.xx * inner.xy + outer.xy * inner.yy,
          .x0 = origin.x,
          .yx = outer.yx * inner.xx + outer.yy * inner.yx,
          .yy = outer.yx * inner.xy + outer.yy * inner.yy,
          .y0 = origin.y};
}

AffineMap rotation_about(PixelPoint center, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);  // rows downwards: to the left is up
  return {.xx = c,
          .xy = s,
          .x0 = center.x - c * center.x - s * center.y,
          .yx = -s,
          .yy = c,
          .y0 = center.y + s * center.x - c * center.y};
}

Region mapped(const Region& region, const AffineMap& map) {
  RecycledVector<Outline> all = outlines(region);
  double left = std::numeric_limits<double>::infinity(), right = -left, top = left, bottom = -left;
  for (Outline& outline : all)
    for (PixelPoint& corner : outline.corners) {
      corner = map * corner;
      expects(std::isfinite(corner.x) && std::isfinite(corner.y), "a map is finite");
      left = std::min(left, corner.x);
      right = std::max(right, corner.x);
      top = std::min(top, corner.y);
      bottom = std::max(bottom, corner.y);
    }
  if (all.empty()) return {};
  using Limits = std::numeric_limits<std::int16_t>;
  expects(left > Limits::min() && top > Limits::min() && right < Limits::max() - 1 && bottom < Limits::max() - 1,
          "a mapped region stays within signed 16 bit");
  // Both sides of what is a line now cross a row at the same place, but for rounding: a pixel may lie in between.
  if (map.xx * map.yy == map.xy * map.yx) return {};
  return region_from_outlines(all, {static_cast<int>(std::floor(left)), static_cast<int>(std::floor(top)),
                                    static_cast<int>(std::ceil(right)) + 1, static_cast<int>(std::ceil(bottom)) + 1});
}

}  // namespace tassilo
