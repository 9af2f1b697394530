#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "tassilo/image/frame.h"

namespace tassilo {

/// Writes frames as a video that gives back each of them to the last bit: its samples in its own chroma resolution and
/// range, its index and time.
///
/// Packed 4:2:2 becomes planar, NV12 becomes planar 4:2:0: the same samples in another order. Ut Video (FFV1 for odd
/// sizes) in Matroska, every frame a key frame and on its way to the disk when `write` returns, so what a crash leaves
/// can be read up to the last frame. Matroska has whole milliseconds; `TARGET.frames.jsonl` has what is exact, and is
/// written before the frame: see FrameSource.
///
/// threads  one at a time
/// cost     some 2 ms for 640x480 on a desktop
class LosslessVideo {
 public:
  /// `target` ends in .mkv; files of that name are replaced. They are opened with the first frame.
  /// Throws Error for another name or a folder that does not exist.
  explicit LosslessVideo(const std::string& target);
  LosslessVideo(const LosslessVideo&) = delete;
  LosslessVideo& operator=(const LosslessVideo&) = delete;
  /// Finishes if that was not done; what fails then is lost, so call `finish`.
  ~LosslessVideo();

  /// Adds a frame; frame.index >= 0 and t finite. All have the first one's size, layout and range.
  /// Throws Error when the disk is full or gone, or the frame is another one.
  void write(const Frame& frame);

  /// Writes what is left. Without frames there is no video. May be called again.
  void finish();

  /// On the disk, or on the way there.
  std::int64_t bytes() const;

 private:
  class Encoder;

  std::string target_;
  std::unique_ptr<Encoder> encoder_;
  std::int64_t bytes_ = 0;
};

}  // namespace tassilo
