#pragma once

#include "tassilo/base/recycled.h"
#include "tassilo/geometry/point.h"

namespace tassilo {

/// An ordered list of sub-pixel points; at least one. HALCON XLD contour.
struct Contour {
  RecycledVector<PixelPoint> points;  ///< [px]
  bool closed = false;                ///< The last point is connected to the first, which is not repeated.
};

/// Sum of the distances from point to point, around for closed ones. HALCON `length_xld`; OpenCV `arcLength`. [px]
double length(const Contour& contour);

}  // namespace tassilo
