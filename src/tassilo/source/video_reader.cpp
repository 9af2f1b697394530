extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "tassilo/base/error.h"
#include "tassilo/source/internal/av_support.h"
#include "tassilo/source/internal/container_size.h"
#include "tassilo/source/internal/frame_reader.h"

namespace tassilo {
namespace {

struct DictionaryDeleter {
  void operator()(AVDictionary* dictionary) const { av_dict_free(&dictionary); }
};

double ratio(AVRational r) { return r.den == 0 ? 0 : static_cast<double>(r.num) / r.den; }

/// value * base, correctly rounded: the stored decimal milliseconds come out as the double nearest to them. [s]
double seconds(std::int64_t value, AVRational base) { return static_cast<double>(value * base.num) / base.den; }

/// A video file or stream through FFmpeg, which by itself hides much of what is broken: concealed slices, skipped
/// clusters, containers cut between packets. Each of these ends the source here, after all pictures before it.
class VideoReader final : public FrameReader {
 public:
  explicit VideoReader(const SourceOptions& options)
      : name_(options.location == "-" ? "standard input" : options.location),
        images_range_(options.images_range),
        interrupted_(options.interrupted),
        live_(options.location.find("://") != std::string::npos && !options.location.starts_with("file://")) {
    open(options);
    find_stream(options);
  }

  std::optional<Frame> next() override {
    while (true) {
      AvFrame picture = make_av_frame();
      const AvLog log;
      const int code = avcodec_receive_frame(codec_.get(), picture.get());
      if (code >= 0) {
        if (const std::string damage = damage_of(*picture, log); !damage.empty()) fail(damage);
        return deliver(std::move(picture));
      }
      if (code == AVERROR_EOF) {
        if (!damage_.empty()) fail(damage_);
        return std::nullopt;
      }
      if (code != AVERROR(EAGAIN)) {
        flush(log.explain("cannot be decoded: " + av_reason(code)));
        continue;
      }
      feed();
    }
  }

  SourceInfo info() const override {
    SourceInfo info;
    info.name = name_;
    info.description = description_;
    info.live = live_;
    const AVStream& stream = *input_->streams[stream_];
    const double fps = ratio(stream.avg_frame_rate);
    if (stream.nb_frames > 0)
      info.frame_count = stream.nb_frames;
    else if (!live_ && input_->duration > 0 && fps > 0)
      info.frame_count = std::llround(static_cast<double>(input_->duration) / AV_TIME_BASE * fps);
    return info;
  }

 private:
  void open(const SourceOptions& options) {
    std::string url = options.location;
    if (url == "-") {
      url = "pipe:0";
    } else if (std::filesystem::exists(url)) {
      missing_bytes_ = missing_bytes(url);
      url = "file:" + url;  // a colon in a file name is no protocol
    }
    AVFormatContext* context = avformat_alloc_context();
    if (context == nullptr) throw std::bad_alloc();
    context->interrupt_callback = {&VideoReader::is_interrupted, this};
    AVDictionary* dictionary = nullptr;
    if (options.fps > 0) av_dict_set(&dictionary, "framerate", std::to_string(options.fps).c_str(), 0);
    const AvLog log;
    const int code = avformat_open_input(&context, url.c_str(), nullptr, &dictionary);  // frees `context` on failure
    const std::unique_ptr<AVDictionary, DictionaryDeleter> unused(dictionary);
    if (code < 0) throw Error(name_, log.explain("cannot be opened as a video: " + av_reason(code)) + cut_remark());
    input_.reset(context);
    container_ = context->iformat->name;
    // The header says everything of these; probing would read ahead to the end of short files and hide where they end.
    if (container_ == "yuv4mpegpipe") return;
    const int found = avformat_find_stream_info(context, nullptr);
    if (found < 0) throw Error(name_, log.explain("cannot be read as a video: " + av_reason(found)) + cut_remark());
    container_error_ = log.container_error();
  }

  void find_stream(const SourceOptions& options) {
    const AvLog log;
    stream_ = av_find_best_stream(input_.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
    if (stream_ < 0) throw Error(name_, "holds no video" + cut_remark());
    const AVStream& stream = *input_->streams[stream_];
    codec_ = open_decoder(name_, *stream.codecpar, options.threads);
    codec_->pkt_timebase = stream.time_base;
    fps_ = options.fps > 0 ? options.fps : ratio(stream.avg_frame_rate);
    if (!(fps_ > 0)) fps_ = ratio(stream.r_frame_rate);
    if (!(fps_ > 0)) fps_ = 25;
  }

  std::string cut_remark() const {
    return missing_bytes_ > 0 ? "; the file is cut short by " + std::to_string(missing_bytes_) + " bytes" : "";
  }

  /// Gives the decoder its next packet, or tells it that there are no more.
  void feed() {
    const AvPacket packet = make_av_packet();
    const AvLog log;
    const int code = av_read_frame(input_.get(), packet.get());
    if (code == AVERROR(EAGAIN)) return;
    if (code < 0) return flush(reason_of_end(code, log));
    const AVStream& stream = *input_->streams[packet->stream_index];
    if (packet->pts != AV_NOPTS_VALUE)
      last_end_ = std::max(last_end_, seconds(packet->pts + packet->duration, stream.time_base));
    if (packet->stream_index != stream_) return;
    // A container reader that stumbles looks for the next place it understands: what lies between is lost.
    if (!log.container_error().empty() && !live_) return flush("is damaged: " + log.container_error());
    if (packet->size == 0) return;
    ++packets_;
    last_packet_end_ = packet->pos >= 0 ? packet->pos + packet->size : -1;
    if ((packet->flags & AV_PKT_FLAG_CORRUPT) != 0 && !live_) return flush("is cut short or damaged");
    if (is_bare_jpeg()) {
      const auto rest = rest_after_jpeg(*packet);
      if (!rest) return flush("is cut short");
      jpeg_rest_ = *rest;
    }
    const int sent = avcodec_send_packet(codec_.get(), packet.get());
    decoder_remark_ = log.decoder_error();
    if (sent < 0 && sent != AVERROR(EAGAIN) && sent != AVERROR_EOF)
      flush(log.explain("cannot be decoded: " + av_reason(sent)));
  }

  /// No more packets: what is in the decoder comes out, then `damage` if there is any.
  void flush(const std::string& damage) {
    if (damage_.empty()) damage_ = damage;
    avcodec_send_packet(codec_.get(), nullptr);
  }

  /// Empty for a source that is complete.
  std::string reason_of_end(int code, const AvLog& log) const {
    if (code == AVERROR_EXIT || (interrupted_ && interrupted_())) return "";
    if (code != AVERROR_EOF) return log.explain("cannot be read: " + av_reason(code));
    if (input_->pb != nullptr && input_->pb->error < 0 && input_->pb->error != AVERROR_EOF)
      return log.explain("cannot be read: " + av_reason(input_->pb->error));
    if (missing_bytes_ > 0) return "cannot be read" + cut_remark();
    const std::string& container_error = log.container_error().empty() ? container_error_ : log.container_error();
    if (!container_error.empty()) return "cannot be read: " + container_error;
    if (container_.starts_with("mov,mp4")) {
      // What the header lists after edit lists have been applied, which may hide pictures on purpose.
      const int listed = avformat_index_get_entries_count(input_->streams[stream_]);
      if (packets_ < listed)
        return "cannot be read: the file holds " + std::to_string(packets_) + " of " + std::to_string(listed) +
               " frames";
    }
    if (container_ == "yuv4mpegpipe" && is_y4m_cut()) return "is cut short";
    if (jpeg_rest_ > 0) return "is cut short";
    if (ends_early()) {
      const double declared = static_cast<double>(input_->duration) / AV_TIME_BASE;
      return "cannot be read: the video ends after " + std::to_string(last_end_) + " s, must last " +
             std::to_string(declared) + " s";
    }
    return "";
  }

  /// The y4m reader drops a last frame that is not complete, without a word.
  bool is_y4m_cut() const {
    constexpr std::int64_t kFrameHeader = 6;  // "FRAME\n", where the packet's position points to
    return last_packet_end_ >= 0 && avio_tell(input_->pb) > last_packet_end_ + kFrameHeader;
  }

  /// Matroska from a pipe: the end is nowhere near the declared duration.
  bool ends_early() const {
    if (!container_.starts_with("matroska") || input_->duration <= 0 || packets_ == 0) return false;
    constexpr double kSlackFrames = 1.5;
    const double declared = static_cast<double>(input_->duration) / AV_TIME_BASE;
    return last_end_ + std::max(kSlackFrames / fps_, largest_gap_) < declared;
  }

  /// One JPEG after the other, without a container.
  bool is_bare_jpeg() const { return container_ == "mjpeg" || container_ == "jpeg_pipe"; }

  /// How many bytes follow a JPEG's end, padding with zeros apart: of the last packet, the beginning of a next one that
  /// is too short to be a packet. Nothing for a JPEG without end.
  static std::optional<std::size_t> rest_after_jpeg(const AVPacket& packet) {
    const std::string_view bytes(reinterpret_cast<const char*>(packet.data), static_cast<std::size_t>(packet.size));
    const std::size_t end = bytes.rfind("\xff\xd9");
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view rest = bytes.substr(end + 2);
    return rest.size() - static_cast<std::size_t>(std::ranges::count(rest, '\0'));
  }

  std::string damage_of(const AVFrame& picture, const AvLog& log) const {
    if (live_) return "";
    if ((picture.flags & AV_FRAME_FLAG_CORRUPT) != 0 || picture.decode_error_flags != 0)
      return log.explain("is damaged");
    // FFV1 hides a slice whose checksum is wrong behind the frame before; it only says so, while it takes the packet.
    const std::string& remark = decoder_remark_.empty() ? log.decoder_error() : decoder_remark_;
    if (codec_->codec_id == AV_CODEC_ID_FFV1 && !remark.empty()) return "is damaged (" + remark + ")";
    return "";
  }

  Frame deliver(AvFrame picture) {
    const std::string subject = name_ + ": frame " + std::to_string(next_index_);
    if (next_index_ > 0 && (picture->width != width_ || picture->height != height_))
      throw Error(subject, "is " + std::to_string(picture->width) + "x" + std::to_string(picture->height) +
                               " px, must be " + std::to_string(width_) + "x" + std::to_string(height_) +
                               " like the frames before");
    width_ = picture->width;
    height_ = picture->height;
    const std::string layout = av_format_name(*picture);
    const bool is_bt709 = picture->colorspace == AVCOL_SPC_BT709;
    const double t = time_of(*picture);
    Frame frame = frame_from_av(std::move(picture), {.name = subject,
                                                     .images_range = images_range_,
                                                     .untagged_is_full = codec_->codec_id == AV_CODEC_ID_MJPEG,
                                                     .gray_is_rgb = codec_->codec_id == AV_CODEC_ID_PNG});
    if (next_index_ > 0) largest_gap_ = std::max(largest_gap_, t - last_t_);
    frame.index = next_index_++;
    frame.t = last_t_ = t;
    if (frame.index == 0) {
      description_ =
          std::string(avcodec_get_name(codec_->codec_id)) + " in " + container_ + ", " + describe_pixels(layout, frame);
      if (is_bt709) description_ += ", BT.709 values (taken as they are)";
    }
    return frame;
  }

  double time_of(const AVFrame& picture) const {
    const std::int64_t stamp = picture.pts != AV_NOPTS_VALUE ? picture.pts : picture.best_effort_timestamp;
    if (stamp != AV_NOPTS_VALUE) return seconds(stamp, input_->streams[stream_]->time_base);
    return next_index_ == 0 ? 0 : last_t_ + 1 / fps_;
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(name_, "frame " + std::to_string(next_index_) + " " + reason);
  }

  static int is_interrupted(void* self) {
    const auto& interrupted = static_cast<VideoReader*>(self)->interrupted_;
    return interrupted && interrupted() ? 1 : 0;
  }

  std::string name_;
  ColorRange images_range_;
  std::function<bool()> interrupted_;
  bool live_;
  AvInput input_;
  AvCodec codec_;
  std::string container_;        ///< FFmpeg's name of the container.
  std::string container_error_;  ///< Met while probing, which may read to the end of a short file.
  std::string description_;
  int stream_ = -1;
  double fps_ = 25;
  std::int64_t missing_bytes_ = 0;
  std::int64_t packets_ = 0;             ///< Of our stream.
  std::size_t jpeg_rest_ = 0;            ///< See rest_after_jpeg; of the last packet.
  std::int64_t last_packet_end_ = -1;    ///< Place in the file; -1: unknown.
  double last_end_ = 0;                  ///< Of all streams. [s]
  double last_t_ = 0, largest_gap_ = 0;  ///< [s]
  std::string decoder_remark_;           ///< Error line of the decoder about the last packet.
  std::string damage_;                   ///< Why the source ended, when it should not have.
  std::int64_t next_index_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace

std::unique_ptr<FrameReader> make_video_reader(const SourceOptions& options) {
  return std::make_unique<VideoReader>(options);
}

}  // namespace tassilo
