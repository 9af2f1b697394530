#pragma once

#include <compare>
#include <span>

#include "tassilo/base/recycled.h"
#include "tassilo/geometry/point.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// Fills polygons by the even-odd rule, all together; the rules for centres on an outline are at `region_from_polygon`.
class PolygonScan {
 public:
  explicit PolygonScan(const PixelBox& window) : window_(window) {}

  /// One closed polygon; fewer than three corners add nothing.
  void add(std::span<const PixelPoint> vertices);
  /// Pixels of the window inside an odd number of polygons.
  Region region() &&;

 private:
  /// Where an edge passes through a row of pixel centres.
  struct Crossing {
    int row = 0;
    double column = 0;

    friend auto operator<=>(const Crossing&, const Crossing&) = default;
  };

  PixelBox window_;
  RecycledVector<Crossing> crossings_;
};

}  // namespace tassilo
