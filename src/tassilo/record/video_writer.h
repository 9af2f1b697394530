#pragma once

#include <memory>
#include <string>

#include "tassilo/overlay/picture.h"

namespace tassilo {

struct VideoOptions {
  int quality = 18;  ///< Of H.264: 0 (lossless) .. 51 (worst); 18 shows no difference.
  int threads = 1;   ///< For encoding. >= 1
  /// Throws Error naming the first field out of range.
  void check() const;
};

/// Writes pictures as a video that plays everywhere: H.264 (MPEG-4 where FFmpeg has no libx264), 4:2:0, in Matroska or
/// MP4.
///
/// The video grows beside the target as `target.part.mkv` (or .mp4) and takes its name in `finish`, so the target is
/// whole or as it was. A Matroska part file that was left by a crash plays up to there. One thread at a time.
class VideoWriter {
 public:
  /// `target` ends in .mkv or .mp4. The file is opened with the first picture.
  /// Throws Error for other extensions, a folder that does not exist or options out of range.
  explicit VideoWriter(const std::string& target, const VideoOptions& options = {});
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;
  /// Finishes if that was not done; what fails then is lost, so call `finish`.
  ~VideoWriter();

  /// Adds a picture that was taken at `t`; the video's clock begins with the first. [s] Times that do not grow by a
  /// millisecond are moved on by one. All pictures have the first's size; odd sides are continued by one column or row.
  /// Throws Error when the disk is full or the size changes.
  void write(const Picture& picture, double t);

  /// Writes what is left and gives the video its name. Without pictures there is no video. May be called again.
  void finish();

 private:
  class Encoder;

  std::string target_;
  VideoOptions options_;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace tassilo
