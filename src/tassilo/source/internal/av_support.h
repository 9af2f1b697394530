#pragma once

#include <cstdarg>
#include <memory>
#include <optional>
#include <string>

#include "tassilo/image/frame.h"

// FFmpeg's types by name only: its headers stay in .cpp files.
struct AVCodecContext;
struct AVCodecParameters;
struct AVFormatContext;
struct AVFrame;
struct AVPacket;

namespace tassilo {

struct AvDeleter {
  void operator()(AVCodecContext* codec) const;
  void operator()(AVFormatContext* input) const;
  void operator()(AVFrame* frame) const;
  void operator()(AVPacket* packet) const;
};
using AvCodec = std::unique_ptr<AVCodecContext, AvDeleter>;
using AvInput = std::unique_ptr<AVFormatContext, AvDeleter>;
using AvFrame = std::unique_ptr<AVFrame, AvDeleter>;
using AvPacket = std::unique_ptr<AVPacket, AvDeleter>;

AvFrame make_av_frame();
AvPacket make_av_packet();

/// FFmpeg's words for an error code, lower-case.
std::string av_reason(int code);

/// While alive, keeps what FFmpeg would print about errors on this thread; without one, FFmpeg says nothing at all.
class AvLog {
 public:
  AvLog();
  AvLog(const AvLog&) = delete;
  AvLog& operator=(const AvLog&) = delete;
  ~AvLog();

  /// First error line of a container reader / of a decoder since the start; empty: none.
  const std::string& container_error() const { return container_error_; }
  const std::string& decoder_error() const { return decoder_error_; }
  /// `reason`, followed by the first error line if there is one.
  std::string explain(const std::string& reason) const;

 private:
  static void receive(void* context, int level, const char* format, va_list arguments);

  mutable std::string container_error_, decoder_error_;  // filled by FFmpeg behind our back
  const AvLog* outer_;
};

/// A decoder for a stream, which reports damage instead of hiding it where the codec can tell.
/// Throws Error(name, ...) when FFmpeg cannot decode the stream.
AvCodec open_decoder(const std::string& name, const AVCodecParameters& stream, int threads);

/// A decoded picture as a Frame: its own memory where the layout is one of ours, else converted; see FrameSource.
///
/// Index, time and image name are left to the caller. Throws Error(name, ...) for layouts that hold no YUV, RGB or gray
/// picture (Bayer, floating point, hardware) and for sizes beyond 32767.
struct AvFrameOptions {
  std::string name;  ///< For messages: the source, and which frame.
  ColorRange images_range = ColorRange::limited;
  bool untagged_is_full = false;  ///< JPEG.
  bool gray_is_rgb = false;       ///< PNG: gray means R = G = B; elsewhere it is luma.
};
Frame frame_from_av(AvFrame picture, const AvFrameOptions& options);

/// "yuv444p", as FFmpeg names the picture's layout.
std::string av_format_name(const AVFrame& picture);

}  // namespace tassilo
