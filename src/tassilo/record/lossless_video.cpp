#include "tassilo/record/lossless_video.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <new>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/files/frames_file.h"
#include "tassilo/record/internal/av_owned.h"
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
      : target_(target),
        shape_(text_of(first.view, first.range)),
        packet_(av_owned(av_packet_alloc())),
        frame_(av_owned(av_frame_alloc())),
        stamps_(stamps_file_of(target).string()) {
    open_codec(first);
    open_file();
  }

  void write(const Frame& frame) {
    if (const std::string shape = text_of(frame.view, frame.range); shape != shape_)
      throw Error(target_,
                  "frame " + std::to_string(frame.index) + " is " + shape + ", must be " + shape_ + " like the first");
    const std::string line = frame_stamp_line({frame.index, frame.t, frame.image});
    stamps_.write(line);
    stamp_bytes_ += static_cast<std::int64_t>(line.size()) + 1;
    if (frames_ == 0) start_ = frame.t;
    const double ms = std::clamp(1000 * (frame.t - start_), 0., 1e15);
    last_stamp_ = frames_ == 0 ? 0 : std::max<std::int64_t>(std::llround(ms), last_stamp_ + 1);
    ++frames_;
    must(av_frame_make_writable(frame_.get()), "be encoded");
    copy_planes(frame.view, *frame_);
    frame_->pts = last_stamp_;
    must(avcodec_send_frame(codec_.get(), frame_.get()), "be encoded");
    drain();
    // Ends the cluster: what is on the disk is whole.
    must(av_write_frame(output_.get(), nullptr), "be written");
    avio_flush(output_->pb);
    must(output_->pb->error, "be written");
  }

  void finish() {
    must(avcodec_send_frame(codec_.get(), nullptr), "be encoded");
    drain();
    must(av_write_trailer(output_.get()), "be written");
    avio_flush(output_->pb);
    must(output_->pb->error, "be written");
    bytes_ = bytes();
    must(avio_closep(&output_->pb), "be written");
  }

  std::int64_t bytes() const {
    return output_->pb != nullptr ? std::max<std::int64_t>(avio_size(output_->pb), 0) + stamp_bytes_ : bytes_;
  }

 private:
  void must(int code, const char* what) const {
    if (code >= 0) return;
    std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
    av_strerror(code, reason.data(), reason.size());
    throw Error(target_, std::string("cannot ") + what + ": " + reason.data());
  }

  void open_codec(const Frame& first) {
    const FrameView& view = first.view;
    const bool is_odd = view.width() % 2 != 0 || view.height() % 2 != 0;
    const AVCodec* encoder = is_odd ? nullptr : avcodec_find_encoder(AV_CODEC_ID_UTVIDEO);
    if (encoder == nullptr) encoder = avcodec_find_encoder(AV_CODEC_ID_FFV1);
    if (encoder == nullptr) throw Error(target_, "cannot be encoded: FFmpeg has neither Ut Video nor FFV1 here");
    codec_ = av_owned(avcodec_alloc_context3(encoder));
    codec_->width = view.width();
    codec_->height = view.height();
    codec_->pix_fmt = is_420(view.format()) ? AV_PIX_FMT_YUV420P : AV_PIX_FMT_YUV422P;
    codec_->time_base = {1, 1000};
    codec_->color_range = first.range == ColorRange::full ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
    codec_->colorspace = AVCOL_SPC_SMPTE170M;  // BT.601
    codec_->thread_count = 1;
    codec_->gop_size = 1;
    if (encoder->id == AV_CODEC_ID_UTVIDEO) {
      must(av_opt_set(codec_->priv_data, "pred", "median", 0), "be encoded");
    } else {
      // Level 3 has checksums, but FFmpeg 5.1 cuts a picture into four slices and loses those that are empty.
      constexpr int least_of_slices = 4;  // [px]
      codec_->level = std::min(view.width(), view.height()) < least_of_slices ? 1 : 3;
      must(av_opt_set(codec_->priv_data, "coder", "rice", 0), "be encoded");
    }
    frame_->format = codec_->pix_fmt;
    frame_->width = codec_->width;
    frame_->height = codec_->height;
    frame_->color_range = codec_->color_range;
    must(av_frame_get_buffer(frame_.get(), 0), "be encoded");
  }

  void open_file() {
    AVFormatContext* output = nullptr;
    must(avformat_alloc_output_context2(&output, nullptr, "matroska", target_.c_str()), "be written");
    output_ = av_owned(output);
    if ((output->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    must(avcodec_open2(codec_.get(), nullptr, nullptr), "be encoded");
    stream_ = avformat_new_stream(output, nullptr);
    if (stream_ == nullptr) throw std::bad_alloc();
    stream_->time_base = codec_->time_base;
    must(avcodec_parameters_from_context(stream_->codecpar, codec_.get()), "be encoded");
    must(avio_open(&output->pb, ("file:" + target_).c_str(), AVIO_FLAG_WRITE), "be opened for writing");
    must(avformat_write_header(output, nullptr), "be written");
  }

  void drain() {
    while (avcodec_receive_packet(codec_.get(), packet_.get()) >= 0) {
      // Matroska keeps it of the last frame only, as the end of the video; a guess might look like frames that are
      // missing.
      packet_->duration = 1;
      av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      const int code = av_write_frame(output_.get(), packet_.get());
      av_packet_unref(packet_.get());
      must(code, "be written");
    }
  }

  std::string target_, shape_;
  Av<AVPacket> packet_;
  Av<AVFrame> frame_;
  Av<AVCodecContext> codec_;
  Av<AVFormatContext> output_;
  AVStream* stream_ = nullptr;
  JsonLinesWriter stamps_;
  double start_ = 0;
  std::int64_t last_stamp_ = 0, frames_ = 0, stamp_bytes_ = 0, bytes_ = 0;
};

LosslessVideo::LosslessVideo(const std::string& target) : target_(target) {
  if (fs::path(target).extension() != ".mkv") throw Error(target, "is no name for a recording, must end in .mkv");
  const fs::path folder = fs::path(target).parent_path();
  if (!folder.empty() && !fs::is_directory(folder)) throw Error(folder.string(), "is no folder to write a video into");
  // Its default would print; a callback that another part has set is not touched by this.
  av_log_set_level(AV_LOG_QUIET);
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
