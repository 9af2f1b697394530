#include "tassilo/image/frame.h"

#include <algorithm>
#include <vector>

#include "tassilo/base/contract.h"

namespace tassilo {

std::string_view to_string(PixelFormat format) {
  switch (format) {
    case PixelFormat::yuyv422:
      return "yuyv422";
    case PixelFormat::uyvy422:
      return "uyvy422";
    case PixelFormat::yuv422p:
      return "yuv422p";
    case PixelFormat::yuv420p:
      return "yuv420p";
    case PixelFormat::nv12:
      return "nv12";
  }
  broken_promise("a known pixel format");
}

std::string_view to_string(ColorRange range) { return range == ColorRange::full ? "full" : "limited"; }

FrameView FrameView::packed(PixelFormat format, int width, int height, const std::uint8_t* data,
                            std::ptrdiff_t stride) {
  expects(format == PixelFormat::yuyv422 || format == PixelFormat::uyvy422, "a packed format");
  const bool y_first = format == PixelFormat::yuyv422;
  FrameView view;
  view.format_ = format;
  view.width_ = width;
  view.height_ = height;
  view.y_ = data + (y_first ? 0 : 1);
  view.u_ = data + (y_first ? 1 : 0);
  view.v_ = view.u_ + 2;
  view.y_stride_ = view.u_stride_ = view.v_stride_ = stride;
  view.y_step_ = 2;
  view.chroma_step_ = 4;
  return view;
}

FrameView FrameView::planar(PixelFormat format, int width, int height, std::array<const std::uint8_t*, 3> planes,
                            std::array<std::ptrdiff_t, 3> strides) {
  expects(format == PixelFormat::yuv422p || format == PixelFormat::yuv420p || format == PixelFormat::nv12,
          "a planar format");
  const bool interleaved = format == PixelFormat::nv12;
  FrameView view;
  view.format_ = format;
  view.width_ = width;
  view.height_ = height;
  view.y_ = planes[0];
  view.u_ = planes[1];
  view.v_ = interleaved ? planes[1] + 1 : planes[2];
  view.y_stride_ = strides[0];
  view.u_stride_ = strides[1];
  view.v_stride_ = interleaved ? strides[1] : strides[2];
  view.chroma_step_ = interleaved ? 2 : 1;
  view.chroma_row_shift_ = format == PixelFormat::yuv422p ? 0 : 1;
  return view;
}

FrameBuffer make_frame_buffer(PixelFormat format, int width, int height, ColorRange range) {
  expects(width >= 0 && height >= 0, "frame size >= 0");
  const std::ptrdiff_t chroma_width = (width + 1) / 2;
  const std::ptrdiff_t chroma_height =
      format == PixelFormat::yuv420p || format == PixelFormat::nv12 ? (height + 1) / 2 : height;
  const bool is_packed = format == PixelFormat::yuyv422 || format == PixelFormat::uyvy422;

  FrameBuffer buffer;
  std::array<std::ptrdiff_t, 3> rows{};
  if (is_packed) {
    buffer.strides = {4 * chroma_width, 0, 0};
    rows = {height, 0, 0};
  } else if (format == PixelFormat::nv12) {
    buffer.strides = {width, 2 * chroma_width, 0};
    rows = {height, chroma_height, 0};
  } else {
    buffer.strides = {width, chroma_width, chroma_width};
    rows = {height, chroma_height, chroma_height};
  }
  std::size_t size = 0;
  for (int p = 0; p < 3; ++p) size += static_cast<std::size_t>(buffer.strides[p] * rows[p]);
  auto bytes =
      std::make_shared<std::vector<std::uint8_t>>(std::max(size, std::size_t{4}));  // addresses, also of no pixels
  std::uint8_t* next = bytes->data();
  for (int p = 0; p < 3; ++p) {
    buffer.planes[p] = next;
    next += buffer.strides[p] * rows[p];
  }
  buffer.frame.view = is_packed
                          ? FrameView::packed(format, width, height, buffer.planes[0], buffer.strides[0])
                          : FrameView::planar(format, width, height,
                                              {buffer.planes[0], buffer.planes[1], buffer.planes[2]}, buffer.strides);
  buffer.frame.range = range;
  buffer.frame.storage = std::move(bytes);
  return buffer;
}

}  // namespace tassilo
