#pragma once

// For tests only.

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tassilo/region/region.h"

namespace tassilo {

/// How random_region fills its box.
struct RandomRegionOptions {
  PixelBox box{0, 0, 20, 12};
  double density = .5;  ///< Chance that a pixel is inside. 0 .. 1
  int boxes = 0;        ///< If > 0: this many random boxes instead of single pixels.
};

/// The pixels of `box` for which `inside(column, row)` holds, built pixel by pixel.
inline Region region_by_pixel(const PixelBox& box, const std::function<bool(int, int)>& inside) {
  RunVector runs;
  for (int r = box.y0; r < box.y1; ++r)
    for (int c = box.x0; c < box.x1; ++c)
      if (inside(c, r))
        runs.push_back({static_cast<std::int16_t>(r), static_cast<std::int16_t>(c), static_cast<std::int16_t>(c + 1)});
  return Region::from_runs(std::move(runs));
}

/// Noise or a few boxes; the same for the same seed.
inline Region random_region(unsigned seed, const RandomRegionOptions& options) {
  std::mt19937 random(seed);
  const PixelBox& box = options.box;
  const auto below = [&](int n) { return n <= 0 ? 0 : static_cast<int>(random() % static_cast<unsigned>(n)); };
  if (options.boxes == 0) {
    const auto threshold = options.density * static_cast<double>(std::mt19937::max());
    return region_by_pixel(box, [&](int, int) { return static_cast<double>(random()) < threshold; });
  }
  RunVector runs;
  for (int k = 0; k < options.boxes; ++k) {
    const int x = box.x0 + below(box.width()), y = box.y0 + below(box.height());
    const int x_end = x + 1 + below(box.x1 - x), y_end = y + 1 + below(box.y1 - y);
    const Region one = Region::from_box({x, y, std::min(x_end, box.x1), std::min(y_end, box.y1)});
    runs.insert(runs.end(), one.runs().begin(), one.runs().end());
  }
  return Region::from_runs(std::move(runs));
}

/// One region of a series that has every width from 1 to 70, thin and dense noise and boxes, also left of and above 0.
struct RandomCase {
  Region region;
  PixelBox box;  ///< All pixels are inside.
};
inline RandomCase random_case(unsigned seed) {
  const int width = 1 + static_cast<int>(seed * 37 % 70), height = 1 + static_cast<int>(seed * 13 % 17);
  const int x = static_cast<int>(seed % 3) * 20 - 40, y = static_cast<int>(seed % 4) * 5 - 10;
  const PixelBox box{x, y, x + width, y + height};
  const double densities[] = {.08, .3, .5, .7, .92};
  return {random_region(seed, {box, densities[seed % 5], seed % 6 == 5 ? 4 : 0}), box};
}
constexpr unsigned kRandomCases = 140;

}  // namespace tassilo
