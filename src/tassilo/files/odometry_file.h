#pragma once

#include <filesystem>
#include <vector>

#include "tassilo/timeline/odometry.h"

namespace tassilo {

/// All samples of odometry.jsonl in order; empty for an empty file.
/// Throws Error("file:line", ...) for a line that is not {"t", "x", "y", "theta"} with finite numbers, or that goes
/// back in time, or whose time repeats.
std::vector<OdometrySample> read_odometry(const std::filesystem::path& file);

}  // namespace tassilo
