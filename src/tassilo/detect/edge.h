#pragma once

#include <optional>

#include "tassilo/geometry/point.h"
#include "tassilo/image/sample.h"

namespace tassilo {

/// Where the color changes from one side to the other along a short line across an edge.
struct EdgeSearch {
  PixelPoint at;             ///< Expected place. [px]
  PixelPoint outward;        ///< Unit vector from the inner to the outer side.
  double reach_px = 3;       ///< How far to look to either side. [px], > 1
  double min_contrast = 20;  ///< Euclidean distance in Y, U, V between both sides. [level]
};

/// Sub-pixel place of the edge: half way between the inner and the outer color, nearest to `at`. Nothing where the
/// contrast is too small or no crossing is found. Cost O(reach_px). Source: own.
std::optional<PixelPoint> find_edge(const FrameView& frame, const EdgeSearch& search);

}  // namespace tassilo
