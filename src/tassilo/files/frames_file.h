#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "tassilo/files/text.h"

namespace tassilo {

/// What a video does not keep of a frame exactly: Matroska has whole milliseconds, and knows of no frame that is
/// missing.
struct FrameStamp {
  std::int64_t index = 0;  ///< As in Frame: frames that were lost leave gaps. >= 0
  double t = 0;            ///< Capture time, to the last bit. [s]
  std::string image;       ///< File name of a single image, else empty.
  friend bool operator==(const FrameStamp&, const FrameStamp&) = default;
};

/// Where the stamps of a video are: VIDEO.frames.jsonl beside it.
std::filesystem::path stamps_file_of(const std::filesystem::path& video);

/// One line of it, without the end: {"frame": 12, "t": 1764288000.123456}. t must be finite.
std::string frame_stamp_line(const FrameStamp& stamp);

/// Reads them one by one, line k for frame k of the video, in bounded memory.
class FrameStampReader {
 public:
  /// Throws Error when the file cannot be read.
  explicit FrameStampReader(const std::filesystem::path& file) : lines_(file, kMaxLine) {}

  /// The next one; nothing at the end. Throws Error("file:line", ...) for a line that is none.
  std::optional<FrameStamp> next();

 private:
  static constexpr std::size_t kMaxLine = 4096;
  LineReader lines_;
};

}  // namespace tassilo
