#include "tassilo/source/internal/av_support.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/log.h>
#include <libavutil/pixdesc.h>
}

#include <array>
#include <cctype>
#include <cstdio>
#include <mutex>
#include <new>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

thread_local const AvLog* current_log = nullptr;

bool is_container_reader(void* context) {
  if (context == nullptr) return false;
  const AVClass* kind = *static_cast<AVClass**>(context);
  if (kind == nullptr) return false;
  const AVClassCategory category = kind->get_category ? kind->get_category(context) : kind->category;
  return category == AV_CLASS_CATEGORY_DEMUXER;
}

std::string one_line(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  return text;
}

/// "Invalid data" begins small like our own words, "CRC mismatch" stays.
std::string lower_first(std::string text) {
  if (text.size() > 1 && std::islower(static_cast<unsigned char>(text[1])))
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace

void AvDeleter::operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
void AvDeleter::operator()(AVFormatContext* input) const { avformat_close_input(&input); }
void AvDeleter::operator()(AVFrame* frame) const { av_frame_free(&frame); }
void AvDeleter::operator()(AVPacket* packet) const { av_packet_free(&packet); }

AvFrame make_av_frame() {
  AvFrame frame(av_frame_alloc());
  if (!frame) throw std::bad_alloc();
  return frame;
}

AvPacket make_av_packet() {
  AvPacket packet(av_packet_alloc());
  if (!packet) throw std::bad_alloc();
  return packet;
}

std::string av_reason(int code) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(code, text.data(), text.size());
  return lower_first(text.data());
}

void AvLog::receive(void* context, int level, const char* format, va_list arguments) {
  if (current_log == nullptr || level > AV_LOG_ERROR) return;
  std::string& line = is_container_reader(context) ? current_log->container_error_ : current_log->decoder_error_;
  if (!line.empty()) return;
  std::array<char, 400> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  line = lower_first(one_line(text.data()));
}

AvLog::AvLog() : outer_(current_log) {
  // FFmpeg has one callback a process; which log a line belongs to is the thread's matter.
  static std::once_flag installed;
  std::call_once(installed, [] { av_log_set_callback(&AvLog::receive); });
  current_log = this;
}

AvLog::~AvLog() { current_log = outer_; }

std::string AvLog::explain(const std::string& reason) const {
  const std::string& line = container_error_.empty() ? decoder_error_ : container_error_;
  return line.empty() ? reason : reason + " (" + line + ")";
}

AvCodec open_decoder(const std::string& name, const AVCodecParameters& stream, int threads) {
  const AVCodec* decoder = avcodec_find_decoder(stream.codec_id);
  if (decoder == nullptr)
    throw Error(name,
                std::string("is coded as ") + avcodec_get_name(stream.codec_id) + ", which FFmpeg cannot decode here");
  AvCodec codec(avcodec_alloc_context3(decoder));
  if (!codec) throw std::bad_alloc();
  const AvLog log;
  int code = avcodec_parameters_to_context(codec.get(), &stream);
  codec->err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER | AV_EF_EXPLODE;
  codec->flags |= AV_CODEC_FLAG_UNALIGNED;  // crop exactly
  codec->thread_count = threads;
  // Frame threads would decode ahead and report damage late and from another thread.
  codec->thread_type = FF_THREAD_SLICE;
  if (code >= 0) code = avcodec_open2(codec.get(), decoder, nullptr);
  if (code < 0)
    throw Error(name, log.explain("its " + std::string(avcodec_get_name(stream.codec_id)) +
                                  " stream cannot be decoded: " + av_reason(code)));
  return codec;
}

std::string av_format_name(const AVFrame& picture) {
  const char* name = av_get_pix_fmt_name(static_cast<AVPixelFormat>(picture.format));
  return name ? name : "unknown";
}

}  // namespace tassilo
