#include "tassilo/region/fill.h"

#include <gtest/gtest.h>

#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/test_regions.h"

namespace tassilo {
namespace {

/// By definition: the background parts of a frame one pixel wider on all sides, without the one that has its corner.
Region holes_by_definition(const Region& region, Connectivity foreground) {
  if (region.empty()) return {};
  const PixelBox box = bounding_box(region);
  const PixelBox domain{box.x0 - 1, box.y0 - 1, box.x1 + 1, box.y1 + 1};
  std::vector<Region> inside;
  for (const Region& part : components(complement(region, domain), dual(foreground)))
    if (!contains(part, domain.x0, domain.y0)) inside.push_back(part);
  return union_of(inside);
}

TEST(Fill, HolesAreTheBackgroundThatDoesNotReachOutside) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    for (const Connectivity foreground : {Connectivity::four, Connectivity::eight}) {
      const Region inside = holes(region, foreground);
      EXPECT_EQ(inside, holes_by_definition(region, foreground));
      const Region filled = fill_holes(region, {.foreground = foreground});
      EXPECT_EQ(filled, union_of(region, inside));
      EXPECT_TRUE(holes(filled, foreground).empty());
    }
  }
}

TEST(Fill, OnlySmallHolesWhenAsked) {
  const Region frame = Region::from_box({0, 0, 20, 10});
  const Region small = Region::from_box({2, 2, 4, 4}), large = Region::from_box({8, 2, 13, 6});
  const Region region = difference(difference(frame, small), large);
  EXPECT_EQ(fill_holes(region, {.max_area_px = 3}), region);
  EXPECT_EQ(fill_holes(region, {.max_area_px = 4}), union_of(region, small));
  EXPECT_EQ(fill_holes(region, {.max_area_px = 19}), union_of(region, small));
  EXPECT_EQ(fill_holes(region, {.min_area_px = 5}), union_of(region, large));
  EXPECT_EQ(fill_holes(region, {.min_area_px = 5, .max_area_px = 19}), region);
  EXPECT_EQ(fill_holes(region), frame);
}

TEST(Fill, DiagonalGapLeaksOnlyForFourConnectedForeground) {
  // A diamond of four pixels around (1, 1).
  const Region diamond = Region::from_runs({{0, 1, 2}, {1, 0, 1}, {1, 2, 3}, {2, 1, 2}});
  EXPECT_EQ(holes(diamond), Region::from_box({1, 1, 2, 2}));
  EXPECT_TRUE(holes(diamond, Connectivity::four).empty());
}

}  // namespace
}  // namespace tassilo
