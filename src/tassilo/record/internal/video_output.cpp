#include "tassilo/record/internal/video_output.h"

#include <array>
#include <filesystem>
#include <new>
#include <utility>

#include "tassilo/base/error.h"

namespace tassilo {

VideoOutput::VideoOutput(std::string path)
    : file(std::move(path)), packet(av_owned(av_packet_alloc())), frame(av_owned(av_frame_alloc())) {}

void VideoOutput::must(int code, const char* what) const {
  if (code >= 0) return;
  std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
  av_strerror(code, reason.data(), reason.size());
  throw Error(file, std::string("cannot ") + what + ": " + reason.data());
}

void VideoOutput::open(const char* container) {
  AVFormatContext* context = nullptr;
  must(avformat_alloc_output_context2(&context, nullptr, container, file.c_str()), "be written");
  format = av_owned(context);
  if ((context->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  must(avcodec_open2(codec.get(), nullptr, nullptr), "be encoded");
  stream = avformat_new_stream(context, nullptr);
  if (stream == nullptr) throw std::bad_alloc();
  stream->time_base = codec->time_base;
  must(avcodec_parameters_from_context(stream->codecpar, codec.get()), "be encoded");
  must(avio_open(&context->pb, ("file:" + file).c_str(), AVIO_FLAG_WRITE), "be opened for writing");
  must(avformat_write_header(context, nullptr), "be written");
}

void prepare_video(const std::string& target) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(target).parent_path();
  if (!folder.empty() && !fs::is_directory(folder)) throw Error(folder.string(), "is no folder to write a video into");
  // Its default would print; a callback that another part has set is not touched by this.
  av_log_set_level(AV_LOG_QUIET);
}

}  // namespace tassilo
