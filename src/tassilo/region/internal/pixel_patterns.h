#pragma once

#include <cstdint>

#include "tassilo/region/region.h"

namespace tassilo {

/// How many 2 x 2 windows of the plane show which pattern of region pixels. Gray's bit quads.
struct PixelPatterns {
  std::int64_t one = 0;       ///< One pixel.
  std::int64_t side = 0;      ///< Two pixels that share an edge.
  std::int64_t diagonal = 0;  ///< Two pixels that share a corner only.
  std::int64_t three = 0;     ///< Three pixels.
};

/// Every window that holds a pixel of the region is looked at, with the outside as background. O(R).
PixelPatterns count_patterns(const Region& region);

}  // namespace tassilo
