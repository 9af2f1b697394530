#pragma once

#include <random>
#include <utility>

#include "tassilo/files/coco_mask.h"

namespace tassilo {

/// Noise of any density on an image of up to 40 x 18 pixels, the same for the same seed. Tests only.
inline CocoMask random_mask(unsigned seed) {
  std::mt19937 random(seed);
  CocoMask mask{1 + static_cast<int>(seed * 7 % 40), 1 + static_cast<int>(seed * 5 % 18), {}};
  const unsigned density = 1 + seed % 9;  // of 10
  RunVector runs;
  for (std::int16_t r = 0; r < mask.height; ++r)
    for (std::int16_t c = 0; c < mask.width; ++c)
      if (random() % 10 < density) runs.push_back({r, c, static_cast<std::int16_t>(c + 1)});
  mask.region = Region::from_runs(std::move(runs));
  return mask;
}

}  // namespace tassilo
