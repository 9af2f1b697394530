#pragma once

#include <cstdint>
#include <vector>

#include "tassilo/image/frame.h"

namespace tassilo {

/// A picture for people: 8-bit R, G, B interleaved, rows from the top, without padding; pixel (c, r) begins at
/// pixels[3 * (r * width + c)].
struct Picture {
  int width = 0, height = 0;  ///< [px]
  std::vector<std::uint8_t> pixels;
  friend bool operator==(const Picture&, const Picture&) = default;
};

/// The frame in RGB by BT.601, each chroma sample for all its pixels, rounded and clipped. Same size; O(pixels).
Picture picture_from_frame(const FrameView& frame, ColorRange range);

}  // namespace tassilo
