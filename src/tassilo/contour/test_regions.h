#pragma once

// For tests only.

#include <cstdint>
#include <random>

#include "tassilo/region/algebra.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// Noise of several densities, or boxes on each other, also left of and above 0; the same for the same seed.
inline Region noise_region(unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const int width = 1 + below(60), height = 1 + below(30), percent = 10 + 20 * below(5);
  RunVector runs;
  if (seed % 4 == 0) {
    for (int k = 0; k < 8; ++k) {
      const int x = below(60), y = below(40);
      const Region box = Region::from_box({x, y, x + 1 + below(30), y + 1 + below(12)});
      runs.insert(runs.end(), box.runs().begin(), box.runs().end());
    }
  } else {
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c)
        if (below(100) < percent)
          runs.push_back(
              {static_cast<std::int16_t>(r), static_cast<std::int16_t>(c), static_cast<std::int16_t>(c + 1)});
  }
  return translated(Region::from_runs(std::move(runs)), {-20, -10});
}

}  // namespace tassilo
