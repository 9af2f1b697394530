#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tassilo/geometry/point.h"
#include "tassilo/image/frame.h"
#include "tassilo/region/features.h"
#include "tassilo/region/raster.h"
#include "tassilo/region/region.h"

namespace tassilo {

// What a region looks like on an image. Pixels of the region that lie outside the image do not count; where none is
// left, all features are 0. All are pure, safe from any thread, and allocate nothing but the clipped region.

/// A borrowed look at one byte per pixel, which need not lie side by side; passed by value, never outlives the bytes.
struct GrayView {
  const std::uint8_t* data = nullptr;
  int width = 0, height = 0;                    ///< [px]
  std::ptrdiff_t row_step = 0, pixel_step = 1;  ///< From row to row, from pixel to pixel. [bytes]

  GrayView(ByteView image);
  /// Brightness Y in the frame's own range: limited frames have 16 to 235.
  GrayView(const FrameView& frame);
};

/// How many pixels have which value.
struct GrayHistogram {
  std::array<std::int64_t, 256> count{};
};
/// HALCON `gray_histo`; OpenCV `calcHist` with a mask; Leptonica `pixGetGrayHistogramMasked`. O(R + pixels).
GrayHistogram gray_histogram(const Region& region, GrayView image);

/// What the histogram tells.
struct GrayFeatures {
  std::int64_t count = 0;  ///< Pixels that were looked at.
  double mean = 0;         ///< HALCON `intensity`; OpenCV `meanStdDev`.
  double deviation = 0;    ///< sqrt(mean squared distance from the mean), of all pixels. HALCON `intensity`.
  int min = 0, max = 0;    ///< HALCON `min_max_gray` with Percent 0; OpenCV `minMaxLoc`.
  int median = 0;          ///< gray_quantile(histogram, .5). HALCON `gray_features` 'median'.
  double entropy = 0;      ///< -sum p log2 p over shares p of values, 0 to 8. HALCON `entropy_gray`. [bit]
};
/// O(256).
GrayFeatures gray_features(const GrayHistogram& histogram);
/// O(R + pixels).
GrayFeatures gray_features(const Region& region, GrayView image);

/// The smallest value v such that at least `share` of the pixels are <= v, and the minimum for share 0; 0 for an empty
/// histogram. HALCON `min_max_gray` with Percent gives the quantiles Percent / 100 and 1 - Percent / 100. O(256).
/// share    0 .. 1
int gray_quantile(const GrayHistogram& histogram, double share);

/// Moments of the region with each pixel weighted by its value.
struct GrayMoments {
  double volume = 0;          ///< Sum of values. HALCON `area_center_gray`.
  PixelPoint center;          ///< Weighted mean of pixel centres. HALCON `area_center_gray`; OpenCV `moments`. [px]
  SecondMoments moments;      ///< Weighted, central, over the volume. [px^2]
  EquivalentEllipse ellipse;  ///< Of these moments. HALCON `elliptic_axis_gray`.
};
/// All 0 where all pixels are 0. O(R + pixels).
GrayMoments gray_moments(const Region& region, GrayView image);

}  // namespace tassilo
