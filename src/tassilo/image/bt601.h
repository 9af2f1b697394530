#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "tassilo/image/frame.h"

namespace tassilo {

/// numerator / denominator, halves rounded up; denominator > 0.
std::int64_t round_ratio(std::int64_t numerator, std::int64_t denominator);

/// Sums of R, G and B; of one pixel or several.
struct RgbSum {
  std::int64_t r = 0, g = 0, b = 0;
};

/// RGB to YUV by BT.601 in exact integers, R, G, B in 0..largest: Y = .299 R + .587 G + .114 B, Cb = (B - Y) / 1.772,
/// Cr = (R - Y) / 1.402, quantized to 8 bit of a range, halves rounded up.
class Bt601 {
 public:
  /// largest > 0.
  explicit Bt601(ColorRange range, int largest = 255);

  std::uint8_t y(RgbSum pixel) const;
  /// Mean chroma of `count` pixels from their sum.
  std::uint8_t cb(RgbSum sum, int count) const;
  std::uint8_t cr(RgbSum sum, int count) const;

 private:
  std::uint8_t chroma(std::int64_t difference, std::int64_t divisor) const;

  std::int64_t luma_offset_, luma_scale_, chroma_scale_, largest_;
};

/// Fills row `r` of a yuv422p buffer from rgb(column), an RgbSum of one pixel; chroma is the mean of a pair's, or of
/// the last column's alone where the width is odd.
template <class Rgb>
void fill_row_from_rgb(const FrameBuffer& buffer, int r, const Bt601& bt601, Rgb rgb) {
  std::uint8_t* y = buffer.planes[0] + r * buffer.strides[0];
  std::uint8_t* u = buffer.planes[1] + r * buffer.strides[1];
  std::uint8_t* v = buffer.planes[2] + r * buffer.strides[2];
  const int width = buffer.frame.view.width();
  for (int c = 0; c < width; c += 2) {
    RgbSum sum;
    const int end = std::min(c + 2, width);
    for (int i = c; i < end; ++i) {
      const RgbSum pixel = rgb(i);
      y[i] = bt601.y(pixel);
      sum = {sum.r + pixel.r, sum.g + pixel.g, sum.b + pixel.b};
    }
    u[c / 2] = bt601.cb(sum, end - c);
    v[c / 2] = bt601.cr(sum, end - c);
  }
}

/// A borrowed look at R, G, B bytes, interleaved, rows from top to bottom; never outlives the bytes.
struct RgbView {
  const std::uint8_t* data = nullptr;
  int width = 0, height = 0;  ///< [px]
  std::ptrdiff_t stride = 0;  ///< From row to row. [bytes]
  bool is_bgr = false;        ///< B, G, R instead.
};

/// The picture as a yuv422p frame of its own pixels, all as Bt601 and fill_row_from_rgb give them. O(pixels), some
/// 4 ns each.
Frame frame_from_rgb(const RgbView& picture, ColorRange range);

}  // namespace tassilo
