#pragma once

#include <string>
#include <vector>

#include "tassilo/vision/vision.h"

// For tests and benchmarks only.

namespace tassilo::test {

/// The table that `tassilo train colors` makes of a samples.yaml, named relative to data/msl98. Throws Error.
ColorTable trained_colors(const std::string& samples_file);

/// A shipped recording in memory, and all that sees it.
struct Recording {
  VisionSetup setup;
  std::vector<Frame> frames;
};
/// `name` as in data/msl98, with colors trained from that camera's samples. Throws Error.
Recording load_recording(const std::string& name, const std::string& samples_file);

}  // namespace tassilo::test
