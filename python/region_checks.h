#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "bindings.h"
#include "tassilo/region/raster.h"
#include "tassilo/region/region.h"

// What operators on regions take for granted, as checks for `def`.

namespace tassilo::python {

inline constexpr int kLow = -32768, kHigh = 32767;
inline constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;

inline std::string text_of(const PixelBox& box) {
  return "(" + std::to_string(box.x0) + ", " + std::to_string(box.y0) + ", " + std::to_string(box.x1) + ", " +
         std::to_string(box.y1) + ")";
}

/// Refuses boxes whose runs would leave 16 bit.
inline void check_box(const std::string& name, const PixelBox& box) {
  if (box.empty() || (box.x0 >= kLow && box.y0 >= kLow && box.x1 <= kHigh && box.y1 <= kHigh + 1)) return;
  refuse(name, "is " + text_of(box) + ", must stay within -32768 .. 32767");
}

inline PixelBox grown(const PixelBox& box, int columns, int rows) {
  return box.empty() ? box : PixelBox{box.x0 - columns, box.y0 - rows, box.x1 + columns, box.y1 + rows};
}

/// For operators that walk the element over the region `times` times: refuses an empty element, and a region that on
/// the way might leave 16 bit.
template <int times>
void check_element(const Region& region, const Region& element) {
  if (element.empty()) refuse("element", "is empty, must have a pixel");
  const PixelBox e = bounding_box(element);
  const int columns = std::max(std::abs(e.x0), std::abs(e.x1)) + e.width();
  const int rows = std::max(std::abs(e.y0), std::abs(e.y1)) + e.height();
  check_box("box of the region, grown by the element,", grown(bounding_box(region), times * columns, times * rows));
}

/// For what has a value for each pixel of a window.
inline void check_window(const PixelBox& window) {
  check_box("window", window);
  if (window.area() > kMostPixels) refuse("window", "is " + text_of(window) + ", must have at most 2^28 pixels");
}

inline ByteView byte_view(const char* name, const py::array& array) {
  const char kind = array.dtype().kind();
  if (array.ndim() != 2 || array.itemsize() != 1 || (kind != 'u' && kind != 'b'))
    refuse(name, "is " + shown(array) + ", must be (height, width) of uint8 or bool");
  if (array.shape(0) > kHigh || array.shape(1) > kHigh)
    refuse(name, "is " + shown(array) + ", must be at most 32767 in each direction");
  if (array.shape(1) > 1 && array.strides(1) != 1)
    refuse(name, "has gaps between the pixels of a row, must have none; numpy.ascontiguousarray makes such a copy");
  return {static_cast<const std::uint8_t*>(array.data()), static_cast<int>(array.shape(1)),
          static_cast<int>(array.shape(0)), array.strides(0)};
}

}  // namespace tassilo::python
