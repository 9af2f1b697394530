#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <memory>
#include <new>

namespace tassilo {

struct AvFree {
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
  void operator()(AVFormatContext* output) const {
    if (output->pb != nullptr) avio_closep(&output->pb);
    avformat_free_context(output);
  }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
template <class T, class Free = AvFree>
using Av = std::unique_ptr<T, Free>;

/// Of what FFmpeg allocated, or could not.
template <class T>
Av<T> av_owned(T* pointer) {
  if (pointer == nullptr) throw std::bad_alloc();
  return Av<T>(pointer);
}

}  // namespace tassilo
