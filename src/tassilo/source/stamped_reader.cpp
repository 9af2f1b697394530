#include <filesystem>
#include <utility>

#include "tassilo/base/error.h"
#include "tassilo/files/frames_file.h"
#include "tassilo/source/internal/frame_reader.h"

namespace tassilo {
namespace {

/// A video whose frames have their indices, times and names from the file beside it.
class StampedReader final : public FrameReader {
 public:
  StampedReader(std::unique_ptr<FrameReader> video, const std::filesystem::path& file)
      : video_(std::move(video)), file_(file), stamps_(file) {}

  std::optional<Frame> next() override {
    std::optional<Frame> frame = video_->next();
    if (!frame) return std::nullopt;
    std::optional<FrameStamp> stamp = stamps_.next();
    if (!stamp)
      throw Error(file_.string(),
                  "has no line for frame " + std::to_string(frame->index) + " of the video, must have one for each");
    frame->index = stamp->index;
    frame->t = stamp->t;
    frame->image = std::move(stamp->image);
    return frame;
  }

  SourceInfo info() const override {
    SourceInfo info = video_->info();
    info.description += ", times of " + file_.filename().string();
    return info;
  }

 private:
  std::unique_ptr<FrameReader> video_;
  std::filesystem::path file_;
  FrameStampReader stamps_;
};

}  // namespace

std::unique_ptr<FrameReader> make_stamped_reader(std::unique_ptr<FrameReader> video, const std::string& location) {
  std::filesystem::path file = stamps_file_of(location);
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return video;
  return std::make_unique<StampedReader>(std::move(video), file);
}

}  // namespace tassilo
