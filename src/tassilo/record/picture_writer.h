#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "tassilo/record/image_folder.h"
#include "tassilo/record/video_writer.h"

namespace tassilo {

/// Annotated pictures, as a video or as numbered PNG files: whatever the target's name says.
class PictureWriter {
 public:
  /// `target`: a folder (an existing one, or a name without extension, which is made), else a video; see VideoWriter.
  explicit PictureWriter(const std::string& target, const VideoOptions& options = {});

  /// The picture of frame `index`, captured at `t`. [s] Throws Error as ImageFolder and VideoWriter do.
  void write(const Picture& picture, std::int64_t index, double t);
  /// Completes a video; see VideoWriter.
  void finish();

 private:
  std::optional<ImageFolder> folder_;
  std::unique_ptr<VideoWriter> video_;
};

}  // namespace tassilo
