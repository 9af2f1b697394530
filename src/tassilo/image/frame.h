#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace tassilo {

/// Byte layout of a frame as cameras and codecs deliver it. Chroma is always 8 bit and horizontally halved.
enum class PixelFormat {
  yuyv422,  ///< packed Y0 U Y1 V
  uyvy422,  ///< packed U Y0 V Y1
  yuv422p,  ///< planes Y, U, V; chroma columns halved
  yuv420p,  ///< planes Y, U, V; chroma columns and rows halved
  nv12,     ///< planes Y, UV interleaved; chroma columns and rows halved
};

/// Lower-case name as FFmpeg writes it.
std::string_view to_string(PixelFormat format);

/// BT.601 quantization: limited has Y 16..235 and chroma 16..240, full uses 0..255 for all.
enum class ColorRange { limited, full };

std::string_view to_string(ColorRange range);

/// Y, U and V of one image row: pixel c is y[c * y_step], u[(c / 2) * chroma_step], v[(c / 2) * chroma_step].
struct YuvRow {
  const std::uint8_t* y = nullptr;
  const std::uint8_t* u = nullptr;
  const std::uint8_t* v = nullptr;
  int y_step = 1;
  int chroma_step = 1;
};

/// A borrowed look at one YUV image in its native layout; small, passed by value, never outlives the pixels.
///
/// One addressing rule serves every format: see `row`. An odd width has a last chroma sample for one pixel.
class FrameView {
 public:
  FrameView() = default;

  /// Packed formats: one plane. `stride` is the distance from row to row. [bytes]
  static FrameView packed(PixelFormat format, int width, int height, const std::uint8_t* data, std::ptrdiff_t stride);
  /// yuv422p, yuv420p: three planes; nv12: the third is ignored. Strides in bytes.
  static FrameView planar(PixelFormat format, int width, int height, std::array<const std::uint8_t*, 3> planes,
                          std::array<std::ptrdiff_t, 3> strides);

  PixelFormat format() const { return format_; }
  int width() const { return width_; }    ///< [px]
  int height() const { return height_; }  ///< [px]
  bool empty() const { return width_ == 0 || height_ == 0; }

  YuvRow row(int r) const {
    const int chroma_row = r >> chroma_row_shift_;
    return {y_ + r * y_stride_, u_ + chroma_row * u_stride_, v_ + chroma_row * v_stride_, y_step_, chroma_step_};
  }
  std::uint8_t y(int c, int r) const { return y_[r * y_stride_ + c * y_step_]; }
  std::uint8_t u(int c, int r) const { return u_[(r >> chroma_row_shift_) * u_stride_ + (c >> 1) * chroma_step_]; }
  std::uint8_t v(int c, int r) const { return v_[(r >> chroma_row_shift_) * v_stride_ + (c >> 1) * chroma_step_]; }

 private:
  PixelFormat format_ = PixelFormat::yuv422p;
  int width_ = 0, height_ = 0;
  const std::uint8_t *y_ = nullptr, *u_ = nullptr, *v_ = nullptr;
  std::ptrdiff_t y_stride_ = 0, u_stride_ = 0, v_stride_ = 0;
  int y_step_ = 1, chroma_step_ = 1, chroma_row_shift_ = 0;
};

/// One camera image with what is known about it. Copies share the pixels, which nobody changes.
struct Frame {
  FrameView view;
  ColorRange range = ColorRange::limited;
  std::int64_t index = 0;               ///< 0-based position in the source; dropped frames are counted.
  double t = 0;                         ///< Capture time on the source's clock. [s]
  std::string image;                    ///< File name for sources made of single images, else empty.
  std::shared_ptr<const void> storage;  ///< Keeps the pixels of `view` alive.
};

/// A frame of its own pixels in `format`, all bytes zero, and the planes to fill it. Sizes >= 0.
struct FrameBuffer {
  Frame frame;
  std::array<std::uint8_t*, 3> planes{};
  std::array<std::ptrdiff_t, 3> strides{};  ///< [bytes]
};
FrameBuffer make_frame_buffer(PixelFormat format, int width, int height, ColorRange range);

}  // namespace tassilo
