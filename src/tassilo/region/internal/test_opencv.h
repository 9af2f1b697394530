#pragma once

// For tests only, where OpenCV is installed.

#include <opencv2/core.hpp>
#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/raster.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// The window's pixels: 255 in the region, else 0.
inline cv::Mat mat_of(const Region& region, const PixelBox& window) {
  const std::vector<std::uint8_t> bytes = to_mask(region, window);
  return cv::Mat(window.height(), window.width(), CV_8U, const_cast<std::uint8_t*>(bytes.data())).clone();
}

/// The pixels of a mask that are not 0; its first one is the window's.
inline Region region_of(const cv::Mat& mask, const PixelBox& window) {
  const ByteView view{mask.data, mask.cols, mask.rows, static_cast<std::ptrdiff_t>(mask.step[0])};
  return translated(region_where(view, [](int byte) { return byte != 0; }), {window.x0, window.y0});
}

inline PixelBox wider(const PixelBox& box, int margin) {
  return {box.x0 - margin, box.y0 - margin, box.x1 + margin, box.y1 + margin};
}

}  // namespace tassilo
