#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "tassilo/timeline/odometry.h"

namespace tassilo {

/// All samples of odometry.jsonl in the order of its lines, whose times may go back and repeat: Odometry takes them so.
/// Empty for an empty file.
/// Throws Error("file:line", ...) for a line that is not {"t", "x", "y", "theta"} with finite numbers.
std::vector<OdometrySample> read_odometry(const std::filesystem::path& file);

/// One such line. `place` is how messages call it. Throws as above.
OdometrySample read_odometry_line(std::string_view line, std::string_view place);

}  // namespace tassilo
