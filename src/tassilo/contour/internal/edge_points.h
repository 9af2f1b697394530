#pragma once

#include <cstdint>

#include "tassilo/base/recycled.h"
#include "tassilo/contour/internal/gradient.h"
#include "tassilo/contour/sub_pixel_edges.h"

namespace tassilo {

// Seen by sub_pixel_edges.cpp, its test and its benchmark only.

/// A maximum of the gradient.
struct EdgePoint {
  float x = 0, y = 0;                     ///< [px]
  std::int16_t column = 0, row = 0;       ///< Of the pixel it was found at. [px]
  std::int16_t slope_x = 0, slope_y = 0;  ///< [gradient_unit]
  std::int32_t squared = 0;               ///< Of the slope.
};

/// All of a region with at least options.low, by row and column.
RecycledVector<EdgePoint> edge_points(const GradientKernel& kernel, const FrameView& frame, const Region& region,
                                      const EdgeOptions& options);

/// Links points to contours.
RecycledVector<Contour> linked(const RecycledVector<EdgePoint>& points, const EdgeOptions& options);

/// `sub_pixel_edges` with a kernel of choice, which this machine must support.
RecycledVector<Contour> sub_pixel_edges_by(const GradientKernel& kernel, const FrameView& frame, const Region& region,
                                           const EdgeOptions& options);

}  // namespace tassilo
