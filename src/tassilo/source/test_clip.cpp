#include "tassilo/source/test_clip.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>

#include "tassilo/source/internal/av_support.h"

namespace tassilo {
namespace {

int must(int code, const char* what) {
  if (code < 0) throw std::runtime_error(std::string(what) + ": " + av_reason(code));
  return code;
}

void drain(AVCodecContext& codec, AVFormatContext& output, AVStream& stream) {
  const AvPacket packet = make_av_packet();
  while (avcodec_receive_packet(&codec, packet.get()) >= 0) {
    av_packet_rescale_ts(packet.get(), codec.time_base, stream.time_base);
    must(av_interleaved_write_frame(&output, packet.get()), "write packet");
  }
}

}  // namespace

PictureBytes noise_picture(const TestClip& clip, unsigned seed) {
  std::mt19937 random(seed);
  PictureBytes bytes(static_cast<std::size_t>(av_image_get_buffer_size(clip.format, clip.width, clip.height, 1)));
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  const AVPixFmtDescriptor* layout = av_pix_fmt_desc_get(clip.format);
  const int depth = layout->comp[0].depth;
  if (depth > 8)  // two bytes a sample, the low one first: keep the unused bits zero
    for (std::size_t i = 1; i < bytes.size(); i += 2) bytes[i] &= static_cast<std::uint8_t>((1 << (depth - 8)) - 1);
  return bytes;
}

void write_clip(const TestClip& clip, const std::vector<PictureBytes>& pictures,
                const std::vector<std::int64_t>& stamps) {
  const AvLog silence;
  AVFormatContext* output = nullptr;
  must(avformat_alloc_output_context2(&output, nullptr, nullptr, clip.path.c_str()), "container");
  const AVCodec* encoder = avcodec_find_encoder_by_name(clip.encoder.c_str());
  if (encoder == nullptr) throw std::runtime_error("no encoder " + clip.encoder);
  const AvCodec codec(avcodec_alloc_context3(encoder));
  codec->width = clip.width;
  codec->height = clip.height;
  codec->pix_fmt = clip.format;
  codec->time_base = {1, 1000};
  codec->framerate = {20, 1};
  codec->color_range = clip.range;
  codec->max_b_frames = clip.b_frames;
  codec->strict_std_compliance = FF_COMPLIANCE_UNOFFICIAL;  // limited-range MJPEG
  codec->global_quality = 2 * FF_QP2LAMBDA;
  codec->flags |= AV_CODEC_FLAG_QSCALE;
  if (clip.encoder == "ffv1") {
    codec->level = 3;
    must(av_opt_set_int(codec->priv_data, "slicecrc", 1, 0), "slicecrc");
  }
  if ((output->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  must(avcodec_open2(codec.get(), encoder, nullptr), "open encoder");
  AVStream* stream = avformat_new_stream(output, nullptr);
  must(avcodec_parameters_from_context(stream->codecpar, codec.get()), "parameters");
  stream->time_base = codec->time_base;
  stream->avg_frame_rate = codec->framerate;
  must(avio_open(&output->pb, clip.path.c_str(), AVIO_FLAG_WRITE), "open file");
  AVDictionary* options = nullptr;
  must(av_dict_parse_string(&options, clip.muxer_options.c_str(), "=", ":", 0), "options");
  must(avformat_write_header(output, &options), "header");
  av_dict_free(&options);

  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const AvFrame frame = make_av_frame();
    frame->format = clip.format;
    frame->width = clip.width;
    frame->height = clip.height;
    frame->color_range = clip.range;
    frame->pts = stamps.at(i);
    must(av_frame_get_buffer(frame.get(), 0), "buffer");
    std::uint8_t* planes[4] = {};
    int strides[4] = {};
    must(av_image_fill_arrays(planes, strides, pictures[i].data(), clip.format, clip.width, clip.height, 1), "arrays");
    const std::uint8_t* from[4] = {planes[0], planes[1], planes[2], planes[3]};
    av_image_copy(frame->data, frame->linesize, from, strides, clip.format, clip.width, clip.height);
    must(avcodec_send_frame(codec.get(), frame.get()), "encode");
    drain(*codec, *output, *stream);
  }
  must(avcodec_send_frame(codec.get(), nullptr), "flush");
  drain(*codec, *output, *stream);
  must(av_write_trailer(output), "trailer");
  avio_closep(&output->pb);
  avformat_free_context(output);
}

std::string read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::string& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

}  // namespace tassilo
