#include "tassilo/message/image_frame.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "tassilo/image/bt601.h"

namespace tassilo {
namespace {

constexpr std::uint32_t kMaxSide = 32767;  // runs have 16-bit coordinates [px]

enum class Kind { packed, nv12, rgb };

struct Encoding {
  std::string_view name;
  Kind kind;
  PixelFormat format;  ///< Of packed and nv12.
  bool is_bgr = false;
};

constexpr std::array kEncodings{
    Encoding{"uyvy", Kind::packed, PixelFormat::uyvy422},
    Encoding{"yuv422", Kind::packed, PixelFormat::uyvy422},
    Encoding{"yuyv", Kind::packed, PixelFormat::yuyv422},
    Encoding{"yuv422_yuy2", Kind::packed, PixelFormat::yuyv422},
    Encoding{"nv12", Kind::nv12, PixelFormat::nv12},
    Encoding{"rgb8", Kind::rgb, PixelFormat::yuv422p},
    Encoding{"bgr8", Kind::rgb, PixelFormat::yuv422p, true},
};

/// As much of somebody's text as can be shown.
std::string shown(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string out;
  for (const char c : text.substr(0, longest)) out += c > ' ' && c <= '~' ? c : '?';
  return text.size() > longest ? out + "..." : out;
}

const Encoding& encoding_of(const std::string& name) {
  for (const Encoding& encoding : kEncodings)
    if (encoding.name == name) return encoding;
  throw UnknownEncoding("encoding", "is " + shown(name) +
                                        ", must be uyvy (yuv422), yuyv (yuv422_yuy2), nv12, rgb8 or "
                                        "bgr8, or the image a JPEG or PNG (CompressedImage)");
}

std::string size_text(const ros::BorrowedImage& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

/// Bytes that a row holds.
std::uint64_t row_bytes(Kind kind, std::uint64_t width) {
  const std::uint64_t pairs = (width + 1) / 2;
  switch (kind) {
    case Kind::packed:
      return 4 * pairs;
    case Kind::nv12:
      return 2 * pairs;
    case Kind::rgb:
      break;
  }
  return 3 * width;
}

void check_layout(const ros::BorrowedImage& image, Kind kind) {
  if (image.width < 1 || image.height < 1 || image.width > kMaxSide || image.height > kMaxSide)
    throw Error("image",
                "is " + size_text(image) + " px, must be 1.." + std::to_string(kMaxSide) + " in both directions");
  const std::uint64_t least = row_bytes(kind, image.width);
  if (image.step < least)
    throw Error("image", "has a step of " + std::to_string(image.step) + " bytes, must be at least " +
                             std::to_string(least) + " for " + std::to_string(image.width) + " px of " +
                             image.encoding);
  const std::uint64_t height = image.height;
  const std::uint64_t rows = kind == Kind::nv12 ? height + (height + 1) / 2 : height;
  if (image.data.size() != rows * image.step)
    throw Error("image", "has " + std::to_string(image.data.size()) + " bytes, must have " +
                             std::to_string(rows * image.step) + ": " + std::to_string(rows) + " rows of " +
                             std::to_string(image.step));
}

}  // namespace

Frame frame_from(const ros::BorrowedImage& image, const ImageRanges& ranges, std::shared_ptr<const void> storage) {
  const Encoding& encoding = encoding_of(image.encoding);
  check_layout(image, encoding.kind);
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  if (encoding.kind == Kind::rgb)
    return frame_from_rgb({image.data.data(), width, height, image.step, encoding.is_bgr}, ranges.rgb);
  const std::ptrdiff_t step = image.step;
  const std::uint8_t* const y = image.data.data();
  Frame frame;
  frame.view = encoding.kind == Kind::packed ? FrameView::packed(encoding.format, width, height, y, step)
                                             : FrameView::planar(encoding.format, width, height,
                                                                 {y, y + height * step, nullptr}, {step, step, 0});
  frame.range = ranges.yuv;
  frame.storage = std::move(storage);
  return frame;
}

}  // namespace tassilo
