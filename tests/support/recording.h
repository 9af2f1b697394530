#pragma once

#include <random>
#include <string>
#include <vector>

#include "tassilo/vision/vision.h"

// For tests and benchmarks only.

namespace tassilo::test {

/// Standard deviations of noise added to every sample of a frame. [level]
struct AddedNoise {
  double y = 0, uv = 0;
};
/// The frame at another size, nearest pixels, with noise; planar 4:2:2. The same for the same random numbers.
Frame resized(const Frame& frame, int width, int height, AddedNoise noise, std::mt19937& random);

/// The table that `tassilo train colors` makes of a samples.yaml, named relative to data/msl98, with noise added to its
/// images. Throws Error.
ColorTable trained_colors(const std::string& samples_file, AddedNoise noise = {});

/// A shipped recording in memory, and all that sees it.
struct Recording {
  VisionSetup setup;
  std::vector<Frame> frames;
};
/// `name` as in data/msl98, with colors trained from that camera's samples. Throws Error.
Recording load_recording(const std::string& name, const std::string& samples_file);

}  // namespace tassilo::test
