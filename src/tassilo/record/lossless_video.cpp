#include "tassilo/record/lossless_video.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/files/frames_file.h"
#include "tassilo/record/internal/video_output.h"
#include "tassilo/record/json_lines_writer.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

bool is_420(PixelFormat format) { return format == PixelFormat::yuv420p || format == PixelFormat::nv12; }

/// Every `step`-th byte.
void gather(const std::uint8_t* from, int step, std::uint8_t* to, int count) {
  if (step == 1) {
    std::memcpy(to, from, static_cast<std::size_t>(count));
  } else if (step == 2) {
    for (int c = 0; c < count; ++c) to[c] = from[2 * c];
  } else {
    for (int c = 0; c < count; ++c) to[c] = from[step * c];
  }
}

void copy_planes(const FrameView& view, AVFrame& to) {
  const int chroma_width = (view.width() + 1) / 2;
  for (int r = 0; r < view.height(); ++r) {
    const YuvRow row = view.row(r);
    gather(row.y, row.y_step, to.data[0] + r * to.linesize[0], view.width());
    if (is_420(view.format()) && r % 2 != 0) continue;
    const int chroma_row = is_420(view.format()) ? r / 2 : r;
    gather(row.u, row.chroma_step, to.data[1] + chroma_row * to.linesize[1], chroma_width);
    gather(row.v, row.chroma_step, to.data[2] + chroma_row * to.linesize[2], chroma_width);
  }
}

std::string text_of(const FrameView& view, ColorRange range) {
  return std::to_string(view.width()) + "x" + std::to_string(view.height()) +
         (is_420(view.format()) ? " 4:2:0 " : " 4:2:2 ") + std::string(to_string(range)) + " range";
}

}  // namespace

/// One video file while it grows.
class LosslessVideo::Encoder {
 public:
  Encoder(const std::string& target, const Frame& first)
      : out_(target), shape_(text_of(first.view, first.range)), stamps_(stamps_file_of(target).string()) {
    open_codec(first);
    out_.open("matroska");
  }

  void write(const Frame& frame) {
    if (const std::string shape = text_of(frame.view, frame.range); shape != shape_)
      throw Error(out_.file,
                  "frame " + std::to_string(frame.index) + " is " + shape + ", must be " + shape_ + " like the first");
    const std::string line = frame_stamp_line({frame.index, frame.t, frame.image});
    stamps_.write(line);
    stamp_bytes_ += static_cast<std::int64_t>(line.size()) + 1;
    if (frames_ == 0) start_ = frame.t;
    const double ms = std::clamp(1000 * (frame.t - start_), 0., 1e15);
    last_stamp_ = frames_ == 0 ? 0 : std::max<std::int64_t>(std::llround(ms), last_stamp_ + 1);
    ++frames_;
    out_.must(av_frame_make_writable(out_.frame.get()), "be encoded");
    copy_planes(frame.view, *out_.frame);
    out_.frame->pts = last_stamp_;
    out_.must(avcodec_send_frame(out_.codec.get(), out_.frame.get()), "be encoded");
    drain();
    // Ends the cluster: what is on the disk is whole.
    out_.must(av_write_frame(out_.format.get(), nullptr), "be written");
    avio_flush(out_.format->pb);
    out_.must(out_.format->pb->error, "be written");
  }

  void finish() {
    out_.must(avcodec_send_frame(out_.codec.get(), nullptr), "be encoded");
    drain();
    out_.must(av_write_trailer(out_.format.get()), "be written");
    avio_flush(out_.format->pb);
    out_.must(out_.format->pb->error, "be written");
    bytes_ = bytes();
    out_.must(avio_closep(&out_.format->pb), "be written");
  }

  std::int64_t bytes() const {
    return out_.format->pb != nullptr ? std::max<std::int64_t>(avio_size(out_.format->pb), 0) + stamp_bytes_ : bytes_;
  }

 private:
  void open_codec(const Frame& first) {
    const FrameView& view = first.view;
    const bool is_odd = view.width() % 2 != 0 || view.height() % 2 != 0;
    const AVCodec* encoder = is_odd ? nullptr : avcodec_find_encoder(AV_CODEC_ID_UTVIDEO);
    if (encoder == nullptr) encoder = avcodec_find_encoder(AV_CODEC_ID_FFV1);
    if (encoder == nullptr) throw Error(out_.file, "cannot be encoded: FFmpeg has neither Ut Video nor FFV1 here");
    out_.codec = av_owned(avcodec_alloc_context3(encoder));
    out_.codec->width = view.width();
    out_.codec->height = view.height();
    out_.codec->pix_fmt = is_420(view.format()) ? AV_PIX_FMT_YUV420P : AV_PIX_FMT_YUV422P;
    out_.codec->time_base = {1, 1000};
    out_.codec->color_range = first.range == ColorRange::full ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    out_.codec->colorspace = AVCOL_SPC_SMPTE170M;  // BT.601
    out_.codec->thread_count = 1;
    out_.codec->gop_size = 1;
    if (encoder->id == AV_CODEC_ID_UTVIDEO) {
      out_.must(av_opt_set(out_.codec->priv_data, "pred", "median", 0), "be encoded");
    } else {
      // Level 3 has checksums, but FFmpeg 5.1 cuts a picture into four slices and loses those that are empty.
      constexpr int least_of_slices = 4;  // [px]
      out_.codec->level = std::min(view.width(), view.height()) < least_of_slices ? 1 : 3;
      out_.must(av_opt_set(out_.codec->priv_data, "coder", "rice", 0), "be encoded");
    }
    out_.frame->format = out_.codec->pix_fmt;
    out_.frame->width = out_.codec->width;
    out_.frame->height = out_.codec->height;
    out_.frame->color_range = out_.codec->color_range;
    out_.must(av_frame_get_buffer(out_.frame.get(), 0), "be encoded");
  }

  void drain() {
    while (avcodec_receive_packet(out_.codec.get(), out_.packet.get()) >= 0) {
      // Matroska keeps it of the last frame only, as the end of the video; a guess might look like frames that are
      // missing.
      out_.packet->duration = 1;
      av_packet_rescale_ts(out_.packet.get(), out_.codec->time_base, out_.stream->time_base);
      out_.packet->stream_index = out_.stream->index;
      const int code = av_write_frame(out_.format.get(), out_.packet.get());
      av_packet_unref(out_.packet.get());
      out_.must(code, "be written");
    }
  }

  VideoOutput out_;
  std::string shape_;
  JsonLinesWriter stamps_;
  double start_ = 0;
  std::int64_t last_stamp_ = 0, frames_ = 0, stamp_bytes_ = 0, bytes_ = 0;
};

LosslessVideo::LosslessVideo(const std::string& target) : target_(target) {
  if (fs::path(target).extension() != ".mkv") throw Error(target, "is no name for a recording, must end in .mkv");
  prepare_video(target);
}

LosslessVideo::~LosslessVideo() {
  try {
    finish();
  } catch (const std::exception&) {
    // Nobody is left to hear it; what was written can be read.
  }
}

void LosslessVideo::write(const Frame& frame) {
  expects(!frame.view.empty(), "LosslessVideo: a frame with pixels");
  if (!encoder_) encoder_ = std::make_unique<Encoder>(target_, frame);
  encoder_->write(frame);
}

void LosslessVideo::finish() {
  const auto encoder = std::move(encoder_);
  if (!encoder) return;
  bytes_ = encoder->bytes();
  encoder->finish();
  bytes_ = encoder->bytes();
}

std::int64_t LosslessVideo::bytes() const { return encoder_ ? encoder_->bytes() : bytes_; }

}  // namespace tassilo
