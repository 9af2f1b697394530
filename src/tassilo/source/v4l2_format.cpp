#include "tassilo/source/internal/v4l2_format.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <tuple>

#include "tassilo/source/internal/frame_reader.h"

namespace tassilo {
namespace {

struct KnownFormat {
  CameraFormat format;
  __u32 fourcc;
};
/// In the order of preference: no decoding first, and chroma in every row.
constexpr std::array kKnownFormats{
    KnownFormat{CameraFormat::yuyv, V4L2_PIX_FMT_YUYV}, KnownFormat{CameraFormat::uyvy, V4L2_PIX_FMT_UYVY},
    KnownFormat{CameraFormat::nv12, V4L2_PIX_FMT_NV12}, KnownFormat{CameraFormat::mjpeg, V4L2_PIX_FMT_MJPEG},
    KnownFormat{CameraFormat::mjpeg, V4L2_PIX_FMT_JPEG}};

const KnownFormat* known_format(__u32 fourcc) {
  const auto* const found = std::ranges::find(kKnownFormats, fourcc, &KnownFormat::fourcc);
  return found == kKnownFormats.end() ? nullptr : found;
}

std::string name_of(__u32 fourcc) {
  if (const KnownFormat* known = known_format(fourcc)) return std::string(to_string(known->format));
  std::string name;
  for (int shift = 0; shift < 32; shift += 8) {
    const char c = static_cast<char>(fourcc >> shift & 0x7f);
    name += c > ' ' && c < 0x7f ? c : '.';
  }
  return name;
}

std::vector<__u32> formats_of(V4l2Device& device) {
  constexpr __u32 kMostFormats = 64;  // a driver that never ends
  std::vector<__u32> formats;
  for (__u32 index = 0; index < kMostFormats; ++index) {
    v4l2_fmtdesc format{};
    format.index = index;
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    const int code = device.try_ask(VIDIOC_ENUM_FMT, &format);
    if (is_gone(code)) throw DeviceError(device.path(), "list its formats", code);
    if (code != 0) break;
    formats.push_back(format.pixelformat);
  }
  return formats;
}

double rate_of(const v4l2_fract& interval) {
  return interval.numerator == 0 ? 0 : static_cast<double>(interval.denominator) / interval.numerator;
}

/// 0: not said.
double highest_rate(V4l2Device& device, __u32 fourcc, int width, int height) {
  constexpr __u32 kMostIntervals = 64;
  double best = 0;
  for (__u32 index = 0; index < kMostIntervals; ++index) {
    v4l2_frmivalenum interval{};
    interval.index = index;
    interval.pixel_format = fourcc;
    interval.width = static_cast<__u32>(width);
    interval.height = static_cast<__u32>(height);
    if (device.try_ask(VIDIOC_ENUM_FRAMEINTERVALS, &interval) != 0) break;
    const bool is_discrete = interval.type == V4L2_FRMIVAL_TYPE_DISCRETE;
    best = std::max(best, rate_of(is_discrete ? interval.discrete : interval.stepwise.min));
    if (!is_discrete) break;
  }
  return best;
}

v4l2_format request_for(__u32 fourcc, const CameraOptions& options) {
  v4l2_format request{};
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  v4l2_pix_format& pix = request.fmt.pix;
  pix.width = static_cast<__u32>(options.width);
  pix.height = static_cast<__u32>(options.height);
  pix.pixelformat = fourcc;
  pix.field = V4L2_FIELD_NONE;
  pix.priv = V4L2_PIX_FMT_PRIV_MAGIC;  // the fields below count
  pix.flags = V4L2_PIX_FMT_FLAG_SET_CSC;
  pix.ycbcr_enc = V4L2_YCBCR_ENC_601;  // for cameras that can choose
  return request;
}

struct Candidate {
  __u32 fourcc;
  std::tuple<int, bool, std::ptrdiff_t> cost;  ///< Size missed, rate missed, place in the order of preference.
};

std::vector<Candidate> candidates(V4l2Device& device, const CameraOptions& options, const std::vector<__u32>& formats) {
  std::vector<Candidate> found;
  for (const __u32 fourcc : formats) {
    const KnownFormat* const known = known_format(fourcc);
    if (known == nullptr || (options.format && *options.format != known->format)) continue;
    v4l2_format answer = request_for(fourcc, options);
    if (device.try_ask(VIDIOC_TRY_FMT, &answer) != 0) answer = request_for(fourcc, options);
    const int width = static_cast<int>(answer.fmt.pix.width), height = static_cast<int>(answer.fmt.pix.height);
    const double rate = highest_rate(device, fourcc, width, height);
    constexpr double kNearlyTheRate = 0.99;  // 29.97
    found.push_back({fourcc,
                     {std::abs(width - options.width) + std::abs(height - options.height),
                      rate > 0 && rate < kNearlyTheRate * options.fps, known - kKnownFormats.data()}});
  }
  std::ranges::stable_sort(found, {}, &Candidate::cost);
  return found;
}

/// What "default" means for each colorspace: the rules of linux/videodev2.h.
const char* foreign_encoding(const v4l2_pix_format& pix) {
  switch (pix.ycbcr_enc) {
    case V4L2_YCBCR_ENC_601:
    case V4L2_YCBCR_ENC_XV601:
      return nullptr;
    case V4L2_YCBCR_ENC_709:
    case V4L2_YCBCR_ENC_XV709:
      return "BT.709";
    case V4L2_YCBCR_ENC_BT2020:
    case V4L2_YCBCR_ENC_BT2020_CONST_LUM:
      return "BT.2020";
    case V4L2_YCBCR_ENC_SMPTE240M:
      return "SMPTE 240M";
    default:
      break;
  }
  switch (pix.colorspace) {
    case V4L2_COLORSPACE_REC709:
    case V4L2_COLORSPACE_DCI_P3:
      return "BT.709";
    case V4L2_COLORSPACE_BT2020:
      return "BT.2020";
    case V4L2_COLORSPACE_SMPTE240M:
      return "SMPTE 240M";
    default:
      return nullptr;
  }
}

ColorRange range_of(const v4l2_pix_format& pix, CameraFormat format) {
  if (format == CameraFormat::mjpeg || pix.quantization == V4L2_QUANTIZATION_FULL_RANGE) return ColorRange::full;
  if (pix.quantization == V4L2_QUANTIZATION_LIM_RANGE) return ColorRange::limited;
  return pix.colorspace == V4L2_COLORSPACE_JPEG ? ColorRange::full : ColorRange::limited;
}

AgreedFormat read_answer(V4l2Device& device, const v4l2_pix_format& pix, const CameraOptions& options) {
  const std::string subject = device.path() + " (" + device.name() + ")";
  const KnownFormat* const known = known_format(pix.pixelformat);
  if (known == nullptr || (options.format && known->format != *options.format))
    throw Error(subject, "sends " + name_of(pix.pixelformat) +
                             " whatever it is asked for, must be yuyv, uyvy, nv12 or "
                             "mjpeg");
  if (pix.field == V4L2_FIELD_TOP || pix.field == V4L2_FIELD_BOTTOM || pix.field == V4L2_FIELD_ALTERNATE)
    throw Error(subject, "sends half frames, every other row at a time; must be whole ones");
  // JPEG is BT.601 by its own standard, whatever the driver says of what comes out of a decoder.
  const char* const foreign = known->format == CameraFormat::mjpeg ? nullptr : foreign_encoding(pix);
  if (foreign != nullptr)
    throw Error(subject, "sends " + std::string(to_string(known->format)) + " with " + foreign +
                             " colors, must be BT.601; another camera format (mjpeg) or a smaller size may have them");
  check_frame_size(subject, static_cast<int>(std::min<__u32>(pix.width, kMaxFrameSize + 1)),
                   static_cast<int>(std::min<__u32>(pix.height, kMaxFrameSize + 1)));
  AgreedFormat agreed;
  agreed.format = known->format;
  agreed.width = static_cast<int>(pix.width);
  agreed.height = static_cast<int>(pix.height);
  agreed.range = options.range.value_or(range_of(pix, known->format));
  constexpr std::size_t kLeastJpeg = 4;  // its two marks
  agreed.least_bytes = kLeastJpeg;
  if (known->format == CameraFormat::mjpeg) return agreed;
  const bool is_nv12 = known->format == CameraFormat::nv12;
  const std::size_t pairs = (pix.width + 1) / 2, row_bytes = is_nv12 ? 2 * pairs : 4 * pairs;
  if (pix.bytesperline != 0 && pix.bytesperline < row_bytes)
    throw Error(subject, "has rows of " + std::to_string(pix.bytesperline) + " bytes, must be at least " +
                             std::to_string(row_bytes));
  const std::size_t stride = std::max<std::size_t>(pix.bytesperline, row_bytes);
  const std::size_t rows = is_nv12 ? pix.height + (pix.height + 1) / 2 : pix.height;
  agreed.stride = static_cast<std::ptrdiff_t>(stride);
  agreed.least_bytes = stride * (rows - 1) + row_bytes;
  return agreed;
}

/// What the camera made of the wanted rate. 0: it does not say.
double agree_on_rate(V4l2Device& device, double fps) {
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  v4l2_captureparm& capture = parameters.parm.capture;
  if (device.try_ask(VIDIOC_G_PARM, &parameters) != 0) return 0;
  if ((capture.capability & V4L2_CAP_TIMEPERFRAME) == 0) return rate_of(capture.timeperframe);
  const bool is_whole = std::round(fps) == fps;  // 29.97 needs more digits
  capture.timeperframe = {is_whole ? 1U : 1000U, static_cast<__u32>(std::lround(is_whole ? fps : fps * 1000))};
  if (device.try_ask(VIDIOC_S_PARM, &parameters) != 0) return 0;
  return rate_of(capture.timeperframe);
}

}  // namespace

std::string to_string(const AgreedFormat& format) {
  std::string text = std::string(to_string(format.format)) + " " + std::to_string(format.width) + "x" +
                     std::to_string(format.height) + " px, " + std::string(to_string(format.range)) + " range";
  if (format.fps <= 0) return text;
  const auto hundredths = std::lround(format.fps * 100);
  text += ", " + std::to_string(hundredths / 100);
  if (hundredths % 100 != 0) text.append(".").append(std::to_string(100 + hundredths % 100).substr(1));
  return text + " frames/s";
}

AgreedFormat agree_on_format(V4l2Device& device, const CameraOptions& options) {
  const std::vector<__u32> formats = formats_of(device);
  const std::vector<Candidate> order = candidates(device, options, formats);
  if (order.empty()) {
    std::string offered;
    for (const __u32 fourcc : formats) offered.append(offered.empty() ? "" : ", ").append(name_of(fourcc));
    throw Error(device.path() + " (" + device.name() + ")",
                "offers " + (offered.empty() ? "no format" : offered) + ", must be " +
                    (options.format ? std::string(to_string(*options.format)) : "yuyv, uyvy, nv12 or mjpeg"));
  }
  std::optional<Error> first_fault;
  for (const Candidate& candidate : order) {
    v4l2_format answer = request_for(candidate.fourcc, options);
    device.ask(VIDIOC_S_FMT, &answer, "take a format");
    try {
      AgreedFormat agreed = read_answer(device, answer.fmt.pix, options);
      agreed.fps = agree_on_rate(device, options.fps);
      return agreed;
    } catch (const DeviceError&) {
      throw;
    } catch (const Error& fault) {
      if (!first_fault) first_fault = fault;
    }
  }
  throw *first_fault;
}

FrameView view_of(const AgreedFormat& format, const std::uint8_t* bytes) {
  if (format.format == CameraFormat::nv12)
    return FrameView::planar(PixelFormat::nv12, format.width, format.height,
                             {bytes, bytes + format.stride * format.height, nullptr},
                             {format.stride, format.stride, 0});
  return FrameView::packed(format.format == CameraFormat::uyvy ? PixelFormat::uyvy422 : PixelFormat::yuyv422,
                           format.width, format.height, bytes, format.stride);
}

std::vector<CameraMode> modes_of(V4l2Device& device) {
  constexpr __u32 kMostSizes = 256;
  std::vector<CameraMode> modes;
  for (const __u32 fourcc : formats_of(device)) {
    const auto add = [&](__u32 wide, __u32 high) {
      const int width = static_cast<int>(wide), height = static_cast<int>(high);
      modes.push_back({name_of(fourcc), known_format(fourcc) != nullptr, width, height,
                       highest_rate(device, fourcc, width, height)});
    };
    for (__u32 index = 0; index < kMostSizes; ++index) {
      v4l2_frmsizeenum size{};
      size.index = index;
      size.pixel_format = fourcc;
      if (device.try_ask(VIDIOC_ENUM_FRAMESIZES, &size) != 0) break;
      if (size.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
        add(size.discrete.width, size.discrete.height);
        continue;
      }
      add(size.stepwise.min_width, size.stepwise.min_height);
      add(size.stepwise.max_width, size.stepwise.max_height);
      break;
    }
  }
  return modes;
}

}  // namespace tassilo
