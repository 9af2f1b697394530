#include "tassilo/region/hit_or_miss.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

bool all_of(const Region& element, auto holds) {
  for (const PixelRun& run : element.runs())
    for (int c = run.begin; c < run.end; ++c)
      if (!holds(c, int{run.row})) return false;
  return true;
}

TEST(HitOrMiss, EqualsTheDefinition) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const Region& of = region;
    // Two disjoint parts of a 5 x 5 window, not symmetric.
    const Region either = random_region(seed + 7, {{-2, -2, 3, 3}, .5, 0});
    Region hit = intersection(either, random_region(seed + 8, {{-2, -2, 3, 3}, .3, 0}));
    const Region miss = intersection(difference(either, hit), random_region(seed + 9, {{-2, -2, 3, 3}, .3, 0}));
    if (hit.empty()) hit = difference(rectangle(1, 1), miss);
    if (hit.empty()) continue;
    const Region expected = region_by_pixel({box.x0 - 3, box.y0 - 3, box.x1 + 3, box.y1 + 3}, [&](int x, int y) {
      return all_of(hit, [&](int c, int r) { return contains(of, x + c, y + r); }) &&
             all_of(miss, [&](int c, int r) { return !contains(of, x + c, y + r); });
    });
    EXPECT_EQ(hit_or_miss(region, hit, miss), expected);
    EXPECT_EQ(hit_or_miss(region, hit, Region{}), erosion(region, hit));
    EXPECT_TRUE(hit_or_miss(region, hit, hit).empty());
  }
}

TEST(HitOrMiss, FindsSinglePixels) {
  const Region region = Region::from_runs({{0, 0, 1}, {0, 2, 4}, {5, 5, 6}});
  const Region around = difference(rectangle(3, 3), rectangle(1, 1));
  EXPECT_EQ(hit_or_miss(region, rectangle(1, 1), around), Region::from_runs({{0, 0, 1}, {5, 5, 6}}));
  EXPECT_DEATH(hit_or_miss(region, Region{}, around), "structuring element");
}

}  // namespace
}  // namespace tassilo
