#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "tassilo/files/odometry_file.h"
#include "tassilo/record/json_lines_writer.h"
#include "tassilo/record/lossless_video.h"

namespace tassilo {

/// What was seen, as a folder that can be seen again: video.mkv with its stamps, scenes.jsonl, odometry.jsonl.
///
/// Whenever the program ends, lines are whole, and of each frame in the video its stamp and its odometry are there.
///
/// threads  one at a time
class RecordingPart {
 public:
  /// `folder` exists; files in it are replaced. Throws Error when they cannot be written.
  RecordingPart(const std::filesystem::path& folder, bool has_odometry);

  /// All below throw Error naming the file that takes no more.
  void write(const OdometryLine& odometry);  ///< Before the first frame that may know it.
  void write(const Frame& frame);
  void write_scene(std::string_view line);  ///< After its frame.
  /// Completes the video.
  void finish();

  /// Sees that what was written outlasts a power cut; may take as long as the disk likes.
  void flush_to_disk() const;
  std::int64_t bytes() const { return video_.bytes() + line_bytes_; }

 private:
  std::filesystem::path folder_;
  LosslessVideo video_;
  JsonLinesWriter scenes_;
  std::optional<JsonLinesWriter> odometry_;
  std::int64_t line_bytes_ = 0;
};

}  // namespace tassilo
