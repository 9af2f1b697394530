#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tassilo/timeline/odometry.h"

namespace tassilo {

/// A line of odometry.jsonl. Recordings say when a sample came: `frame` is the index of the first frame that could know
/// it.
struct OdometryLine {
  OdometrySample sample;
  std::optional<std::int64_t> frame = {};  ///< Nothing: known from the start.
  friend bool operator==(const OdometryLine&, const OdometryLine&) = default;
};

/// All samples of odometry.jsonl in the order of its lines, whose times may go back and repeat: Odometry takes them so.
/// Empty for an empty file.
/// Throws Error("file:line", ...) for a line that is not {"t", "x", "y", "theta"} with finite numbers, and perhaps
/// "frame" with a whole one.
std::vector<OdometrySample> read_odometry(const std::filesystem::path& file);
/// The same with what they say of frames.
std::vector<OdometryLine> read_odometry_lines(const std::filesystem::path& file);

/// One such line. `place` is how messages call it. Throws as above.
OdometryLine read_odometry_line(std::string_view line, std::string_view place);
/// Reads back to the last bit; without the line's end. All numbers must be finite.
std::string odometry_line(const OdometryLine& line);

}  // namespace tassilo
