#include "tassilo/overlay/picture.h"

#include <algorithm>

namespace tassilo {
namespace {

std::uint8_t to_byte(double value) { return static_cast<std::uint8_t>(std::clamp(value + .5, 0.0, 255.0)); }

}  // namespace

Picture picture_from_frame(const FrameView& frame, ColorRange range) {
  const bool is_full = range == ColorRange::full;
  const double luma_offset = is_full ? 0 : 16;
  const double luma_gain = is_full ? 1 : 255.0 / 219;
  const double chroma_gain = is_full ? 1 : 255.0 / 224;
  // From Y, Pb = (B - Y) / 1.772 and Pr = (R - Y) / 1.402 back to R, G, B.
  const double red_gain = 1.402 * chroma_gain, blue_gain = 1.772 * chroma_gain;
  const double green_gain_u = -.114 / .587 * blue_gain, green_gain_v = -.299 / .587 * red_gain;

  Picture picture{frame.width(), frame.height(), {}};
  picture.pixels.resize(3 * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  std::uint8_t* next = picture.pixels.data();
  for (int r = 0; r < picture.height; ++r) {
    const YuvRow row = frame.row(r);
    for (int c = 0; c < picture.width; ++c, next += 3) {
      const double y = luma_gain * (row.y[c * row.y_step] - luma_offset);
      const double u = row.u[(c / 2) * row.chroma_step] - 128.0, v = row.v[(c / 2) * row.chroma_step] - 128.0;
      next[0] = to_byte(y + red_gain * v);
      next[1] = to_byte(y + green_gain_u * u + green_gain_v * v);
      next[2] = to_byte(y + blue_gain * u);
    }
  }
  return picture;
}

}  // namespace tassilo
