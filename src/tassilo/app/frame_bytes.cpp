#include "tassilo/app/frame_bytes.h"

#include <bit>
#include <cstring>
#include <string_view>

#include "tassilo/base/contract.h"

namespace tassilo {
namespace {

constexpr std::string_view kMagic = "TYUV";

struct Header {
  char magic[4];
  std::uint32_t width, height, range;
  std::int64_t frame;
  double t;
};
static_assert(sizeof(Header) == 32 && std::endian::native == std::endian::little, "written as it lies in memory");

std::size_t chroma_width(int width) { return static_cast<std::size_t>(width + 1) / 2; }

}  // namespace

std::string frame_bytes(const Frame& frame) {
  const int width = frame.view.width(), height = frame.view.height();
  const Header header{{kMagic[0], kMagic[1], kMagic[2], kMagic[3]},
                      static_cast<std::uint32_t>(width),
                      static_cast<std::uint32_t>(height),
                      frame.range == ColorRange::full,
                      frame.index,
                      frame.t};
  const std::size_t w = static_cast<std::size_t>(width), half = chroma_width(width),
                    h = static_cast<std::size_t>(height);
  std::string bytes(sizeof header + (w + 2 * half) * h, '\0');
  std::memcpy(bytes.data(), &header, sizeof header);
  char* y = bytes.data() + sizeof header;
  char* u = y + w * h;
  char* v = u + half * h;
  for (int r = 0; r < height; ++r) {
    const YuvRow row = frame.view.row(r);
    for (std::size_t c = 0; c < w; ++c) *y++ = static_cast<char>(row.y[c * static_cast<std::size_t>(row.y_step)]);
    for (std::size_t c = 0; c < half; ++c) {
      *u++ = static_cast<char>(row.u[c * static_cast<std::size_t>(row.chroma_step)]);
      *v++ = static_cast<char>(row.v[c * static_cast<std::size_t>(row.chroma_step)]);
    }
  }
  return bytes;
}

Frame frame_of_bytes(std::shared_ptr<const std::string> bytes) {
  expects(bytes->size() >= sizeof(Header) && bytes->starts_with(kMagic), "frame_of_bytes: bytes of frame_bytes");
  Header header;
  std::memcpy(&header, bytes->data(), sizeof header);
  const std::size_t w = header.width, half = chroma_width(static_cast<int>(header.width)), h = header.height;
  expects(bytes->size() == sizeof header + (w + 2 * half) * h, "frame_of_bytes: all bytes of a frame");
  const auto* y = reinterpret_cast<const std::uint8_t*>(bytes->data()) + sizeof header;
  Frame frame;
  frame.view = FrameView::planar(
      PixelFormat::yuv422p, static_cast<int>(w), static_cast<int>(h), {y, y + w * h, y + (w + half) * h},
      {static_cast<std::ptrdiff_t>(w), static_cast<std::ptrdiff_t>(half), static_cast<std::ptrdiff_t>(half)});
  frame.range = header.range != 0 ? ColorRange::full : ColorRange::limited;
  frame.index = header.frame;
  frame.t = header.t;
  frame.storage = std::move(bytes);
  return frame;
}

}  // namespace tassilo
