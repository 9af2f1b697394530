#include "tassilo/record/picture_writer.h"

#include <filesystem>

namespace tassilo {

PictureWriter::PictureWriter(const std::string& target, const VideoOptions& options) {
  const std::filesystem::path path(target);
  if (std::filesystem::is_directory(path) || !path.has_extension())
    folder_.emplace(target);
  else
    video_ = std::make_unique<VideoWriter>(target, options);
}

void PictureWriter::write(const Picture& picture, std::int64_t index, double t) {
  if (folder_)
    folder_->write(picture, index);
  else
    video_->write(picture, t);
}

void PictureWriter::finish() {
  if (video_) video_->finish();
}

}  // namespace tassilo
