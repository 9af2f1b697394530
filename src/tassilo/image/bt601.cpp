#include "tassilo/image/bt601.h"

#include <utility>

namespace tassilo {
namespace {

std::uint8_t to_byte(std::int64_t value) { return static_cast<std::uint8_t>(std::clamp<std::int64_t>(value, 0, 255)); }

std::int64_t luma(RgbSum c) { return 299 * c.r + 587 * c.g + 114 * c.b; }

/// Bt601 of 8-bit values, with divisors that the compiler knows: no division is left. All numerators are within 31 bits
/// and, with 128 added before dividing, not negative.
template <ColorRange range>
struct Bt601Of8Bit {
  static constexpr int kLumaOffset = range == ColorRange::full ? 0 : 16;
  static constexpr int kLumaScale = range == ColorRange::full ? 255 : 219;
  static constexpr int kChromaScale = range == ColorRange::full ? 255 : 224;
  static constexpr int kLargest = 255;

  static std::uint8_t y(int luma) {
    constexpr unsigned divisor = 1000 * kLargest;
    return static_cast<std::uint8_t>(kLumaOffset +
                                     (2 * kLumaScale * static_cast<unsigned>(luma) + divisor) / (2 * divisor));
  }
  /// weight  1772 of blue, 1402 of red
  template <int weight, int count>
  static std::uint8_t chroma(int difference) {
    constexpr int divisor = weight * count * kLargest;
    const auto numerator = static_cast<unsigned>(2 * kChromaScale * difference + (1 + 2 * 128) * divisor);
    return static_cast<std::uint8_t>(std::min(255U, numerator / (2U * divisor)));
  }
};

/// Where the values of a row go.
struct YuvBytes {
  std::uint8_t *y, *u, *v;
};

template <ColorRange range, int red>
void fill_row(const std::uint8_t* rgb, int width, const YuvBytes& out) {
  using Bt = Bt601Of8Bit<range>;
  constexpr int blue = 2 - red;
  const auto luma_of = [](const std::uint8_t* p) { return 299 * p[red] + 587 * p[1] + 114 * p[blue]; };
  const int pairs = width / 2;
  for (int i = 0; i < pairs; ++i) {
    const std::uint8_t* const p = rgb + 6 * static_cast<std::ptrdiff_t>(i);
    const int first = luma_of(p), second = luma_of(p + 3), sum = first + second;
    out.y[2 * i] = Bt::y(first);
    out.y[2 * i + 1] = Bt::y(second);
    out.u[i] = Bt::template chroma<1772, 2>(1000 * (p[blue] + p[3 + blue]) - sum);
    out.v[i] = Bt::template chroma<1402, 2>(1000 * (p[red] + p[3 + red]) - sum);
  }
  if (width % 2 == 0) return;
  const std::uint8_t* const p = rgb + 6 * static_cast<std::ptrdiff_t>(pairs);
  const int last = luma_of(p);
  out.y[2 * pairs] = Bt::y(last);
  out.u[pairs] = Bt::template chroma<1772, 1>(1000 * p[blue] - last);
  out.v[pairs] = Bt::template chroma<1402, 1>(1000 * p[red] - last);
}

using FillRow = void (*)(const std::uint8_t* rgb, int width, const YuvBytes& out);
FillRow fill_row_for(ColorRange range, bool is_bgr) {
  if (range == ColorRange::full) return is_bgr ? fill_row<ColorRange::full, 2> : fill_row<ColorRange::full, 0>;
  return is_bgr ? fill_row<ColorRange::limited, 2> : fill_row<ColorRange::limited, 0>;
}

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
  const FillRow fill = fill_row_for(range, picture.is_bgr);
  for (int r = 0; r < picture.height; ++r)
    fill(picture.data + r * picture.stride, picture.width,
         {buffer.planes[0] + r * buffer.strides[0], buffer.planes[1] + r * buffer.strides[1],
          buffer.planes[2] + r * buffer.strides[2]});
  return std::move(buffer.frame);
}

}  // namespace tassilo
