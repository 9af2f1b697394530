#include "tassilo/region/remove_noise.h"

#include <gtest/gtest.h>

#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/internal/test_regions.h"

namespace tassilo {
namespace {

TEST(RemoveNoise, KeepsPixelsWithANeighbor) {
  const std::vector<std::pair<int, int>> edges{{0, -1}, {-1, 0}, {1, 0}, {0, 1}},
      corners{{-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const auto kept = [&, &of = region](const std::vector<std::pair<int, int>>& steps) {
      return region_by_pixel(box, [&](int c, int r) {
        return contains(of, c, r) &&
               std::ranges::any_of(steps, [&](auto step) { return contains(of, c + step.first, r + step.second); });
      });
    };
    EXPECT_EQ(remove_noise(region, NoiseNeighbors::n_4), kept(edges));
    EXPECT_EQ(remove_noise(region, NoiseNeighbors::n_8), kept(corners));
    EXPECT_EQ(remove_noise(region, NoiseNeighbors::n_48), union_of(kept(edges), kept(corners)));

    std::vector<Region> larger;
    for (const Region& part : components(region))
      if (area(part) > 1) larger.push_back(part);
    EXPECT_EQ(remove_noise(region, NoiseNeighbors::n_48), union_of(larger));
  }
}

}  // namespace
}  // namespace tassilo
