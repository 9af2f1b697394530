#pragma once

#include <filesystem>

#include "tassilo/files/document.h"
#include "tassilo/files/samples_file.h"

namespace tassilo {

/// The shape that the keys rectangle, polygon, stroke and radius, or mask and value say; masks are relative to
/// `folder`. Throws Error with the place when there is not exactly one.
SampleShape sample_shape_of(const Map& map, const std::filesystem::path& folder);

}  // namespace tassilo
