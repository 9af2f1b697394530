#include "tassilo/record/video_writer.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <new>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/record/internal/av_owned.h"

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
        part_(fs::path(target).replace_extension(".part" + fs::path(target).extension().string()).string()),
        width_(first.width),
        height_(first.height),
        packet_(av_owned(av_packet_alloc())),
        frame_(av_owned(av_frame_alloc())),
        scaler_(owned_scaler(sws_getContext(even(width_), even(height_), AV_PIX_FMT_RGB24, even(width_), even(height_),
                                            AV_PIX_FMT_YUV420P, SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT,
                                            nullptr, nullptr, nullptr))) {
    open_codec(options);
    open_file();
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
    must(av_frame_make_writable(frame_.get()), "convert");
    pad(picture);
    const std::uint8_t* rows[] = {padded_.data()};
    const int stride[] = {3 * even(width_)};
    sws_scale(scaler_.get(), rows, stride, 0, even(height_), frame_->data, frame_->linesize);
    frame_->pts = last_stamp_;
    must(avcodec_send_frame(codec_.get(), frame_.get()), "be encoded");
    drain();
  }

  void finish() {
    must(avcodec_send_frame(codec_.get(), nullptr), "be encoded");
    drain();
    must(av_write_trailer(output_.get()), "be written");
    must(avio_closep(&output_->pb), "be written");
    std::error_code problem;
    fs::rename(part_, target_, problem);
    if (problem) throw Error(target_, "cannot be named so: " + problem.message() + " (the video is " + part_ + ")");
  }

 private:
  void must(int code, const char* what) const {
    if (code >= 0) return;
    std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
    av_strerror(code, reason.data(), reason.size());
    throw Error(part_, std::string("cannot ") + what + ": " + reason.data());
  }

  void open_codec(const VideoOptions& options) {
    const AVCodec* h264 = avcodec_find_encoder_by_name("libx264");
    const AVCodec* encoder = h264 ? h264 : avcodec_find_encoder(AV_CODEC_ID_MPEG4);
    if (encoder == nullptr) throw Error(target_, "cannot be encoded: FFmpeg has neither libx264 nor MPEG-4 here");
    codec_ = av_owned(avcodec_alloc_context3(encoder));
    codec_->width = even(width_);
    codec_->height = even(height_);
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    codec_->time_base = {1, 1000};
    codec_->color_range = AVCOL_RANGE_MPEG;
    codec_->colorspace = AVCOL_SPC_SMPTE170M;  // BT.601, as swscale converts
    codec_->thread_count = options.threads;
    codec_->gop_size = 50;  // pictures from one place to jump to to the next
    if (h264) {
      must(av_opt_set(codec_->priv_data, "preset", "veryfast", 0), "be encoded");
      must(av_opt_set_int(codec_->priv_data, "crf", options.quality, 0), "be encoded");
    } else {
      codec_->flags |= AV_CODEC_FLAG_QSCALE;
      codec_->global_quality = FF_QP2LAMBDA * std::clamp(options.quality / 6, 1, 31);
    }
    frame_->format = codec_->pix_fmt;
    frame_->width = codec_->width;
    frame_->height = codec_->height;
    must(av_frame_get_buffer(frame_.get(), 0), "be encoded");
  }

  void open_file() {
    AVFormatContext* output = nullptr;
    must(avformat_alloc_output_context2(&output, nullptr, nullptr, part_.c_str()), "be written");
    output_ = av_owned(output);
    if ((output->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    must(avcodec_open2(codec_.get(), nullptr, nullptr), "be encoded");
    stream_ = avformat_new_stream(output, nullptr);
    if (stream_ == nullptr) throw std::bad_alloc();
    stream_->time_base = codec_->time_base;
    must(avcodec_parameters_from_context(stream_->codecpar, codec_.get()), "be encoded");
    must(avio_open(&output->pb, ("file:" + part_).c_str(), AVIO_FLAG_WRITE), "be opened for writing");
    must(avformat_write_header(output, nullptr), "be written");
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
    while (avcodec_receive_packet(codec_.get(), packet_.get()) >= 0) {
      packet_->duration = duration;
      av_packet_rescale_ts(packet_.get(), codec_->time_base, stream_->time_base);
      packet_->stream_index = stream_->index;
      must(av_interleaved_write_frame(output_.get(), packet_.get()), "be written");
    }
  }

  std::string target_, part_;
  int width_, height_;
  Av<AVPacket> packet_;
  Av<AVFrame> frame_;
  std::unique_ptr<SwsContext, ScalerFree> scaler_;
  Av<AVCodecContext> codec_;
  Av<AVFormatContext> output_;
  AVStream* stream_ = nullptr;
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
  const fs::path folder = fs::path(target).parent_path();
  if (!folder.empty() && !fs::is_directory(folder)) throw Error(folder.string(), "is no folder to write a video into");
  // Its default would print; a callback that another part has set is not touched by this.
  av_log_set_level(AV_LOG_QUIET);
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
