#pragma once

#include <span>

#include "tassilo/image/frame.h"

namespace tassilo {

/// Y, U, V between pixels.
struct YuvValue {
  double y = 0, u = 0, v = 0;
};

/// Places along a straight line. [px]
struct SampleLine {
  double column = 0, row = 0;            ///< The first one.
  double column_step = 0, row_step = 0;  ///< From one to the next.
};

/// Bilinear value at a sub-pixel position; beyond the border the border's value. The frame must not be empty.
///
/// Chroma samples lie in the middle of the pixels that share them, as the mean of those pixels. O(1).
YuvValue sample(const FrameView& frame, double column, double row);
/// `sample` at `values.size()` places from (column, row) on, each (column_step, row_step) behind the one before; the
/// same values, faster where all of them lie away from the border. O(values).
void sample_line(const FrameView& frame, const SampleLine& line, std::span<YuvValue> values);
/// Brightness alone.
double sample_y(const FrameView& frame, double column, double row);

}  // namespace tassilo
