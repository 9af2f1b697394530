#include "tassilo/image/bt601.h"

#include <utility>

namespace tassilo {
namespace {

std::uint8_t to_byte(std::int64_t value) { return static_cast<std::uint8_t>(std::clamp<std::int64_t>(value, 0, 255)); }

std::int64_t luma(RgbSum c) { return 299 * c.r + 587 * c.g + 114 * c.b; }

}  // namespace

std::int64_t round_ratio(std::int64_t numerator, std::int64_t denominator) {
  const std::int64_t twice = 2 * numerator + denominator;
  const std::int64_t quotient = twice / (2 * denominator);
  return twice % (2 * denominator) < 0 ? quotient - 1 : quotient;
}

Bt601::Bt601(ColorRange range, int largest)
    : luma_offset_(range == ColorRange::full ? 0 : 16),
      luma_scale_(range == ColorRange::full ? 255 : 219),
      chroma_scale_(range == ColorRange::full ? 255 : 224),
      largest_(largest) {}

std::uint8_t Bt601::y(RgbSum pixel) const {
  return to_byte(luma_offset_ + round_ratio(luma_scale_ * luma(pixel), 1000 * largest_));
}

std::uint8_t Bt601::cb(RgbSum sum, int count) const { return chroma(1000 * sum.b - luma(sum), 1772 * count); }

std::uint8_t Bt601::cr(RgbSum sum, int count) const { return chroma(1000 * sum.r - luma(sum), 1402 * count); }

std::uint8_t Bt601::chroma(std::int64_t difference, std::int64_t divisor) const {
  return to_byte(128 + round_ratio(chroma_scale_ * difference, divisor * largest_));
}

Frame frame_from_rgb(const RgbView& picture, ColorRange range) {
  FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv422p, picture.width, picture.height, range);
  const Bt601 bt601(range);
  for (int r = 0; r < picture.height; ++r) {
    const std::uint8_t* row = picture.data + r * picture.stride;
    fill_row_from_rgb(buffer, r, bt601, [&](int c) { return RgbSum{row[3 * c], row[3 * c + 1], row[3 * c + 2]}; });
  }
  return std::move(buffer.frame);
}

}  // namespace tassilo
