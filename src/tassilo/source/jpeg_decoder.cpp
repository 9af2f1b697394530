#include "tassilo/source/internal/jpeg_decoder.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

#include <cstring>
#include <new>
#include <string_view>
#include <utility>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

AvCodec open_mjpeg(const std::string& name) {
  AVCodecParameters stream{};
  stream.codec_type = AVMEDIA_TYPE_VIDEO;
  stream.codec_id = AV_CODEC_ID_MJPEG;
  stream.format = AV_PIX_FMT_NONE;
  return open_decoder(name, stream, 1);
}

/// The decoder fills up a JPEG without its end in gray, silently.
bool is_complete(std::span<const std::uint8_t> jpeg) {
  const std::string_view bytes(reinterpret_cast<const char*>(jpeg.data()), jpeg.size());
  return bytes.starts_with("\xff\xd8") && bytes.rfind("\xff\xd9") != std::string_view::npos;
}

}  // namespace

JpegDecoder::JpegDecoder(std::string name) : name_(std::move(name)), codec_(open_mjpeg(name_)) {}

std::optional<Frame> JpegDecoder::decode(std::span<const std::uint8_t> jpeg) {
  if (!is_complete(jpeg)) return std::nullopt;
  const AvPacket packet = make_av_packet();
  if (av_new_packet(packet.get(), static_cast<int>(jpeg.size())) < 0) throw std::bad_alloc();
  std::memcpy(packet->data, jpeg.data(), jpeg.size());
  AvFrame picture = make_av_frame();
  const AvLog log;
  int code = avcodec_send_packet(codec_.get(), packet.get());
  if (code >= 0) code = avcodec_receive_frame(codec_.get(), picture.get());
  // An error line without an error code is a picture with missing parts.
  if (code < 0 || !log.decoder_error().empty()) {
    avcodec_flush_buffers(codec_.get());
    return std::nullopt;
  }
  try {
    return frame_from_av(std::move(picture), {.name = name_, .untagged_is_full = true});
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace tassilo
