#include "tassilo/source/picture.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

#include <cstring>
#include <new>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/source/internal/picture_bytes.h"

namespace tassilo {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30;

}  // namespace

AvFrame decode_image(const PictureOptions& options, std::string_view bytes) {
  const std::string& name = options.name;
  expects(options.max_pixels >= 1, "decode_picture: at least one pixel");
  AVCodecParameters stream{};
  stream.codec_type = AVMEDIA_TYPE_VIDEO;
  stream.format = AV_PIX_FMT_NONE;
  if (bytes.starts_with(kPngStart))
    stream.codec_id = AV_CODEC_ID_PNG;
  else if (bytes.starts_with(kJpegStart))
    stream.codec_id = AV_CODEC_ID_MJPEG;
  else
    throw Error(name, bytes.empty() ? "is empty, must be a PNG or JPEG image" : "is no PNG or JPEG image");
  // The decoder fills up a JPEG without its end in gray, silently.
  if (stream.codec_id == AV_CODEC_ID_MJPEG && bytes.rfind(kJpegEnd) == std::string_view::npos)
    throw Error(name, "is cut short: a JPEG image without its end");

  const AvLog log;
  const AvCodec codec = open_decoder(name, stream, 1);
  codec->max_pixels = options.max_pixels;
  if (bytes.size() > kMostBytes) throw Error(name, "is larger than 1 GiB");
  const AvPacket packet = make_av_packet();
  if (av_new_packet(packet.get(), static_cast<int>(bytes.size())) < 0) throw std::bad_alloc();
  std::memcpy(packet->data, bytes.data(), bytes.size());
  AvFrame picture = make_av_frame();
  int code = avcodec_send_packet(codec.get(), packet.get());
  if (code >= 0) code = avcodec_send_packet(codec.get(), nullptr);
  if (code >= 0) code = avcodec_receive_frame(codec.get(), picture.get());
  // An error line without an error code is a picture with missing parts.
  if (code < 0 || !log.decoder_error().empty()) throw Error(name, log.explain("is damaged or cut short"));
  return picture;
}

Frame frame_from_picture(AvFrame picture, const PictureOptions& options, std::string_view bytes) {
  return frame_from_av(std::move(picture), {.name = options.name,
                                            .images_range = options.images_range,
                                            .untagged_is_full = true,
                                            .gray_is_rgb = bytes.starts_with(kPngStart)});
}

Frame decode_picture(std::span<const std::uint8_t> file, const PictureOptions& options) {
  const std::string_view bytes(reinterpret_cast<const char*>(file.data()), file.size());
  return frame_from_picture(decode_image(options, bytes), options, bytes);
}

}  // namespace tassilo
