#pragma once

#include "tassilo/image/frame.h"

namespace tassilo {

/// Y, U, V between pixels.
struct YuvValue {
  double y = 0, u = 0, v = 0;
};

/// Bilinear value at a sub-pixel position; beyond the border the border's value. The frame must not be empty.
///
/// Chroma samples lie in the middle of the pixels that share them, as the mean of those pixels. O(1).
YuvValue sample(const FrameView& frame, double column, double row);
/// Brightness alone.
double sample_y(const FrameView& frame, double column, double row);

}  // namespace tassilo
