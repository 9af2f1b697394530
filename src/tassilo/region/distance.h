#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "tassilo/base/recycled.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// How far two pixels are apart, for dc columns and dr rows between their centres.
enum class DistanceMetric {
  euclidean_squared,  ///< dc^2 + dr^2; exact.
  chessboard,         ///< max(dc, dr), steps to eight neighbors.
  city_block,         ///< dc + dr, steps to four neighbors.
};

/// One distance for each pixel of a window.
struct DistanceImage {
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();  ///< There is no pixel to reach.

  PixelBox window;
  RecycledVector<std::int32_t> values;  ///< Row by row without gaps. [px], euclidean_squared [px^2]

  std::int32_t at(int column, int row) const {
    return values[static_cast<std::size_t>(row - window.y0) * static_cast<std::size_t>(window.width()) +
                  static_cast<std::size_t>(column - window.x0)];
  }
};

/// For each pixel of the window the distance to the nearest pixel of the region: 0 inside it, kNone everywhere for the
/// empty region. The window only says where values are asked for: the region beyond it counts, too. HALCON
/// `distance_transform` with Foreground 'false'; OpenCV `distanceTransform` of the complement, which rounds.
///
/// window   together with the region not wider nor higher than 32768 px, so that squares fit 32 bit
/// cost     O(width of the window x (rows of the window + rows of the region)); safe from any thread
/// source   Meijster, Roerdink, Hesselink, "A general algorithm for computing distance transforms in linear time",
///          Mathematical Morphology and its Applications to Image and Signal Processing, 2000; squares by convex
///          hulls and short distances by trying rows, own.
DistanceImage distance_to(const Region& region, const PixelBox& window,
                          DistanceMetric metric = DistanceMetric::euclidean_squared);

/// For each pixel of the window the distance to the nearest pixel outside the region: 0 outside it, 1 on its boundary.
/// Outside the window the region is as it is, the image's border plays no part. HALCON `distance_transform` with
/// Foreground 'true'; OpenCV `distanceTransform`; Leptonica `pixDistanceFunction`. The region keeps
/// one pixel away from the limits of 16 bit; the rest as `distance_to`.
DistanceImage distance_inside(const Region& region, const PixelBox& window,
                              DistanceMetric metric = DistanceMetric::euclidean_squared);

}  // namespace tassilo
