#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tassilo/geometry/box.h"
#include "tassilo/image/frame.h"
#include "tassilo/region/region.h"

namespace tassilo::bench {

/// Field lines as cameras see them: frames of one camera, and what is white in each.
struct FieldLines {
  std::string name;  ///< "640x480 synthetic", "384x172 recorded (d01_approach)".
  std::vector<Frame> frames;
  std::vector<Region> lines;

  PixelBox window() const { return {0, 0, frames[0].view.width(), frames[0].view.height()}; }
};

/// 0, 1: the lines of a field and noise, computed, at 640x480 and 1920x1080. 2, 3: recordings at 640x480 and 384x172
/// with their trained tables, where walls are white, too.
constexpr int kFieldLines = 4;
const FieldLines& field_lines(int index);

}  // namespace tassilo::bench
