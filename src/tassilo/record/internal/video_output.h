#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <string>

#include "tassilo/record/internal/av_owned.h"

namespace tassilo {

/// What writing a video needs whatever its codec: one stream in one file.
struct VideoOutput {
  explicit VideoOutput(std::string path);

  /// Throws Error("FILE", "cannot WHAT: ..") when FFmpeg says no.
  void must(int code, const char* what) const;
  /// Opens the codec and the file, and writes its header. container: null is by the file's name.
  void open(const char* container);

  std::string file;
  Av<AVPacket> packet;
  Av<AVFrame> frame;
  Av<AVCodecContext> codec;
  Av<AVFormatContext> format;
  AVStream* stream = nullptr;
};

/// Throws Error when the folder of a video is not there, and lets FFmpeg print nothing.
void prepare_video(const std::string& target);

}  // namespace tassilo
