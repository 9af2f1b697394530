#include "tassilo/record/video_writer.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <new>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/record/internal/video_output.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

struct ScalerFree {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};
std::unique_ptr<SwsContext, ScalerFree> owned_scaler(SwsContext* scaler) {
  if (scaler == nullptr) throw std::bad_alloc();
  return std::unique_ptr<SwsContext, ScalerFree>(scaler);
}

int even(int size) { return size + size % 2; }

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

}  // namespace

/// One video file while it grows.
class VideoWriter::Encoder {
 public:
  Encoder(const std::string& target, const Picture& first, const VideoOptions& options)
      : target_(target),
        out_(fs::path(target).replace_extension(".part" + fs::path(target).extension().string()).string()),
        width_(first.width),
        height_(first.height),
        scaler_(owned_scaler(sws_getContext(even(width_), even(height_), AV_PIX_FMT_RGB24, even(width_), even(height_),
                                            AV_PIX_FMT_YUV420P, SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT,
                                            nullptr, nullptr, nullptr))) {
    open_codec(options);
    out_.open(nullptr);
    padded_.resize(3 * static_cast<std::size_t>(even(width_)) * static_cast<std::size_t>(even(height_)));
  }

  void write(const Picture& picture, double t) {
    if (picture.width != width_ || picture.height != height_)
      throw Error(target_, "picture " + std::to_string(pictures_) + " is " + size_text(picture.width, picture.height) +
                               " px, must be " + size_text(width_, height_) + " like the first");
    if (pictures_ == 0) start_ = t;
    const auto stamp = static_cast<std::int64_t>(std::llround(1000 * (t - start_)));
    last_stamp_ = pictures_ == 0 ? 0 : std::max(stamp, last_stamp_ + 1);
    ++pictures_;
    out_.must(av_frame_make_writable(out_.frame.get()), "convert");
    pad(picture);
    const std::uint8_t* rows[] = {padded_.data()};
    const int stride[] = {3 * even(width_)};
    sws_scale(scaler_.get(), rows, stride, 0, even(height_), out_.frame->data, out_.frame->linesize);
    out_.frame->pts = last_stamp_;
    out_.must(avcodec_send_frame(out_.codec.get(), out_.frame.get()), "be encoded");
    drain();
  }

  void finish() {
    out_.must(avcodec_send_frame(out_.codec.get(), nullptr), "be encoded");
    drain();
    out_.must(av_write_trailer(out_.format.get()), "be written");
    out_.must(avio_closep(&out_.format->pb), "be written");
    std::error_code problem;
    fs::rename(out_.file, target_, problem);
    if (problem) throw Error(target_, "cannot be named so: " + problem.message() + " (the video is " + out_.file + ")");
  }

 private:
  void open_codec(const VideoOptions& options) {
    const AVCodec* h264 = avcodec_find_encoder_by_name("libx264");
    const AVCodec* encoder = h264 ? h264 : avcodec_find_encoder(AV_CODEC_ID_MPEG4);
    if (encoder == nullptr) throw Error(target_, "cannot be encoded: FFmpeg has neither libx264 nor MPEG-4 here");
    out_.codec = av_owned(avcodec_alloc_context3(encoder));
    out_.codec->width = even(width_);
    out_.codec->height = even(height_);
    out_.codec->pix_fmt = AV_PIX_FMT_YUV420P;
    out_.codec->time_base = {1, 1000};
    out_.codec->color_range = AVCOL_RANGE_MPEG;
    out_.codec->colorspace = AVCOL_SPC_SMPTE170M;  // BT.601, as swscale converts
    out_.codec->thread_count = options.threads;
    out_.codec->gop_size = 50;  // pictures from one place to jump to to the next
    if (h264) {
      out_.must(av_opt_set(out_.codec->priv_data, "preset", "veryfast", 0), "be encoded");
      out_.must(av_opt_set_int(out_.codec->priv_data, "crf", options.quality, 0), "be encoded");
    } else {
      out_.codec->flags |= AV_CODEC_FLAG_QSCALE;
      out_.codec->global_quality = FF_QP2LAMBDA * std::clamp(options.quality / 6, 1, 31);
    }
    out_.frame->format = out_.codec->pix_fmt;
    out_.frame->width = out_.codec->width;
    out_.frame->height = out_.codec->height;
    out_.must(av_frame_get_buffer(out_.frame.get(), 0), "be encoded");
  }

  /// The picture with even sides, the last column and row twice if need be.
  void pad(const Picture& picture) {
    const std::size_t from_row = 3 * static_cast<std::size_t>(width_),
                      to_row = 3 * static_cast<std::size_t>(even(width_));
    for (int r = 0; r < even(height_); ++r) {
      const std::uint8_t* from = picture.pixels.data() + from_row * static_cast<std::size_t>(std::min(r, height_ - 1));
      std::uint8_t* to = padded_.data() + to_row * static_cast<std::size_t>(r);
      std::copy_n(from, from_row, to);
      if (to_row > from_row) std::copy_n(from + from_row - 3, 3, to + from_row);
    }
  }

  void drain() {
    // A last picture without duration would not be shown in MP4.
    constexpr std::int64_t kUsualMs = 40;
    const std::int64_t duration = pictures_ > 1 ? std::max<std::int64_t>(1, last_stamp_ / (pictures_ - 1)) : kUsualMs;
    while (avcodec_receive_packet(out_.codec.get(), out_.packet.get()) >= 0) {
      out_.packet->duration = duration;
      av_packet_rescale_ts(out_.packet.get(), out_.codec->time_base, out_.stream->time_base);
      out_.packet->stream_index = out_.stream->index;
      out_.must(av_interleaved_write_frame(out_.format.get(), out_.packet.get()), "be written");
    }
  }

  std::string target_;
  VideoOutput out_;
  int width_, height_;
  std::unique_ptr<SwsContext, ScalerFree> scaler_;
  std::vector<std::uint8_t> padded_;
  double start_ = 0;
  std::int64_t last_stamp_ = 0, pictures_ = 0;
};

void VideoOptions::check() const {
  if (quality < 0 || quality > 51) throw Error("video.quality", "is " + std::to_string(quality) + ", must be 0..51");
  if (threads < 1) throw Error("video.threads", "is " + std::to_string(threads) + ", must be >= 1");
}

VideoWriter::VideoWriter(const std::string& target, const VideoOptions& options) : target_(target), options_(options) {
  options.check();
  const std::string extension = fs::path(target).extension().string();
  if (extension != ".mkv" && extension != ".mp4")
    throw Error(target, "is no name for a video, must end in .mkv or .mp4");
  prepare_video(target);
}

VideoWriter::~VideoWriter() {
  try {
    finish();
  } catch (const std::exception&) {
    // Nobody is left to hear it; the part file stays.
  }
}

void VideoWriter::write(const Picture& picture, double t) {
  expects(picture.width > 0 && picture.height > 0, "VideoWriter: a picture with pixels");
  if (!encoder_) encoder_ = std::make_unique<Encoder>(target_, picture, options_);
  encoder_->write(picture, t);
}

void VideoWriter::finish() {
  if (const auto encoder = std::move(encoder_)) encoder->finish();
}

}  // namespace tassilo
