extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/image/bt601.h"
#include "tassilo/source/internal/av_support.h"
#include "tassilo/source/internal/frame_reader.h"

namespace tassilo {
namespace {

using Samples = std::vector<std::uint16_t>;

std::optional<PixelFormat> native_format(AVPixelFormat format) {
  switch (format) {
    case AV_PIX_FMT_YUYV422:
      return PixelFormat::yuyv422;
    case AV_PIX_FMT_UYVY422:
      return PixelFormat::uyvy422;
    case AV_PIX_FMT_YUV422P:
    case AV_PIX_FMT_YUVJ422P:
      return PixelFormat::yuv422p;
    case AV_PIX_FMT_YUV420P:
    case AV_PIX_FMT_YUVJ420P:
      return PixelFormat::yuv420p;
    case AV_PIX_FMT_NV12:
      return PixelFormat::nv12;
    default:
      return std::nullopt;
  }
}

bool is_full_by_format(AVPixelFormat format) {
  switch (format) {
    case AV_PIX_FMT_YUVJ411P:
    case AV_PIX_FMT_YUVJ420P:
    case AV_PIX_FMT_YUVJ422P:
    case AV_PIX_FMT_YUVJ440P:
    case AV_PIX_FMT_YUVJ444P:
      return true;
    default:
      return false;
  }
}

ColorRange yuv_range(const AVFrame& picture, bool untagged_is_full) {
  if (is_full_by_format(static_cast<AVPixelFormat>(picture.format))) return ColorRange::full;
  if (picture.color_range == AVCOL_RANGE_JPEG) return ColorRange::full;
  if (picture.color_range == AVCOL_RANGE_MPEG) return ColorRange::limited;
  return untagged_is_full ? ColorRange::full : ColorRange::limited;
}

Frame native_frame(AvFrame picture, PixelFormat format, ColorRange range) {
  Frame frame;
  const AVFrame& p = *picture;
  if (format == PixelFormat::yuyv422 || format == PixelFormat::uyvy422)
    frame.view = FrameView::packed(format, p.width, p.height, p.data[0], p.linesize[0]);
  else
    frame.view = FrameView::planar(format, p.width, p.height, {p.data[0], p.data[1], p.data[2]},
                                   {p.linesize[0], p.linesize[1], p.linesize[2]});
  frame.range = range;
  frame.storage = std::shared_ptr<const AVFrame>(std::move(picture));
  return frame;
}

/// Any layout FFmpeg can describe, component by component as plain numbers.
class ComponentReader {
 public:
  explicit ComponentReader(const AVFrame& picture)
      : picture_(picture), layout_(*av_pix_fmt_desc_get(static_cast<AVPixelFormat>(picture.format))) {}

  const AVPixFmtDescriptor& layout() const { return layout_; }
  int largest(int component) const { return (1 << layout_.comp[component].depth) - 1; }
  /// Of the deepest component; the others (rgb565) are stretched to it by `read_color`.
  int largest() const {
    int deepest = 0;
    for (int k = 0; k < layout_.nb_components; ++k) deepest = std::max(deepest, largest(k));
    return deepest;
  }
  bool has_palette() const { return (layout_.flags & AV_PIX_FMT_FLAG_PAL) != 0; }

  /// `samples` of a component from the start of its row `r`, in the component's own resolution.
  void read(int component, int r, Samples& samples) const {
    constexpr int kBytesPerSample = 2;
    // The function takes arrays of const pointers; AVFrame has arrays of pointers.
    const std::uint8_t* planes[4] = {picture_.data[0], picture_.data[1], picture_.data[2], picture_.data[3]};
    const int strides[4] = {picture_.linesize[0], picture_.linesize[1], picture_.linesize[2], picture_.linesize[3]};
    av_read_image_line2(samples.data(), planes, strides, &layout_, 0, r, component, static_cast<int>(samples.size()), 0,
                        kBytesPerSample);
  }

  void read_color(int component, int r, Samples& samples) const {
    read(component, r, samples);
    const int from = largest(component), to = largest();
    if (from == to) return;
    for (std::uint16_t& sample : samples) sample = static_cast<std::uint16_t>((sample * to + from / 2) / from);
  }

  /// R, G, B of a palette entry. 0..255
  std::array<int, 3> palette(int index) const {
    const std::uint32_t argb = reinterpret_cast<const std::uint32_t*>(picture_.data[1])[index];
    return {static_cast<int>(argb >> 16 & 255), static_cast<int>(argb >> 8 & 255), static_cast<int>(argb & 255)};
  }

 private:
  const AVFrame& picture_;
  const AVPixFmtDescriptor& layout_;
};

std::uint8_t to_byte(std::int64_t value) { return static_cast<std::uint8_t>(std::clamp<std::int64_t>(value, 0, 255)); }

Frame from_rgb(const AVFrame& picture, ColorRange range) {
  const ComponentReader reader(picture);
  const int width = picture.width;
  const bool is_gray = reader.layout().nb_components < 3 && !reader.has_palette();
  const Bt601 bt601(range, reader.has_palette() ? 255 : reader.largest());
  FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv422p, width, picture.height, range);
  Samples red(static_cast<std::size_t>(width)), green(red), blue(red);
  for (int r = 0; r < picture.height; ++r) {
    reader.read_color(0, r, red);
    if (reader.has_palette()) {
      for (std::size_t c = 0; c < red.size(); ++c) {
        const auto color = reader.palette(red[c]);
        red[c] = static_cast<std::uint16_t>(color[0]);
        green[c] = static_cast<std::uint16_t>(color[1]);
        blue[c] = static_cast<std::uint16_t>(color[2]);
      }
    } else if (is_gray) {
      green = blue = red;
    } else {
      reader.read_color(1, r, green);
      reader.read_color(2, r, blue);
    }
    fill_row_from_rgb(buffer, r, bt601, [&](int c) {
      const auto at = static_cast<std::size_t>(c);
      return RgbSum{red[at], green[at], blue[at]};
    });
  }
  return std::move(buffer.frame);
}

/// `depth` bits to 8 of the same range: limited values are shifted (ITU-R BT.601 puts the extra bits below the point),
/// full ones are scaled so that the largest stays the largest. `sum` of `count` samples.
struct DepthChange {
  int depth;
  ColorRange range;

  std::uint8_t luma(std::int64_t sum, int count) const {
    if (range == ColorRange::limited) return to_byte(round_ratio(256 * sum, count * (std::int64_t{1} << depth)));
    return to_byte(round_ratio(255 * sum, count * ((std::int64_t{1} << depth) - 1)));
  }
  std::uint8_t chroma(std::int64_t sum, int count) const {
    if (range == ColorRange::limited) return luma(sum, count);
    const std::int64_t middle = std::int64_t{1} << (depth - 1);
    return to_byte(128 + round_ratio(255 * (sum - count * middle), count * ((std::int64_t{1} << depth) - 1)));
  }
};

Frame from_yuv(const AVFrame& picture, ColorRange range) {
  const ComponentReader reader(picture);
  const AVPixFmtDescriptor& layout = reader.layout();
  const int width = picture.width;
  const bool has_chroma = layout.nb_components >= 3;
  const DepthChange depth{layout.comp[0].depth, range};
  FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv422p, width, picture.height, range);
  Samples luma(static_cast<std::size_t>(width));
  Samples chroma(static_cast<std::size_t>(AV_CEIL_RSHIFT(width, layout.log2_chroma_w)));
  for (int r = 0; r < picture.height; ++r) {
    reader.read(0, r, luma);
    std::uint8_t* y = buffer.planes[0] + r * buffer.strides[0];
    for (int c = 0; c < width; ++c) y[c] = depth.luma(luma[static_cast<std::size_t>(c)], 1);
    for (int component = 1; component <= 2; ++component) {
      std::uint8_t* target =
          buffer.planes[static_cast<std::size_t>(component)] + r * buffer.strides[static_cast<std::size_t>(component)];
      if (!has_chroma) {
        std::fill_n(target, (width + 1) / 2, std::uint8_t{128});
        continue;
      }
      reader.read(component, r >> layout.log2_chroma_h, chroma);
      for (int c = 0; c < width; c += 2) {
        std::int64_t sum = 0;
        const int end = std::min(c + 2, width);
        for (int i = c; i < end; ++i) sum += chroma[static_cast<std::size_t>(i >> layout.log2_chroma_w)];
        target[c / 2] = depth.chroma(sum, end - c);
      }
    }
  }
  return std::move(buffer.frame);
}

}  // namespace

Frame frame_from_av(AvFrame picture, const AvFrameOptions& options) {
  check_frame_size(options.name, picture->width, picture->height);
  const auto format = static_cast<AVPixelFormat>(picture->format);
  const ColorRange range = yuv_range(*picture, options.untagged_is_full);
  if (const auto native = native_format(format)) return native_frame(std::move(picture), *native, range);

  const AVPixFmtDescriptor* layout = av_pix_fmt_desc_get(format);
  constexpr std::uint64_t kForeign = AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_BAYER | AV_PIX_FMT_FLAG_FLOAT;
  const bool is_foreign = layout == nullptr || (layout->flags & kForeign) != 0 || layout->nb_components == 0 ||
                          layout->comp[0].depth > 16 || format == AV_PIX_FMT_MONOWHITE ||
                          picture->colorspace == AVCOL_SPC_YCGCO ||
                          (layout->name && std::string_view(layout->name).starts_with("xyz"));
  if (is_foreign)
    throw Error(options.name,
                "has pixel format " + av_format_name(*picture) + ", must be YUV, RGB or gray of at most 16 bit");
  const bool is_gray = layout->nb_components < 3;
  const bool is_rgb = (layout->flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL)) != 0;
  if (is_rgb || (is_gray && options.gray_is_rgb)) return from_rgb(*picture, options.images_range);
  return from_yuv(*picture, range);
}

}  // namespace tassilo
