#include "tassilo/region/transform.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/test_regions.h"

namespace tassilo {
namespace {

TEST(Mirror, EqualsPixelByPixelAndTwiceIsNothing) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const Region& of = region;
    for (const int doubled : {-9, 0, 4, 7}) {
      const double about = doubled / 2.;
      const PixelBox sideways{doubled - box.x1 + 1, box.y0, doubled - box.x0 + 1, box.y1};
      EXPECT_EQ(mirrored_left_right(region, about),
                region_by_pixel(sideways, [&](int c, int r) { return contains(of, doubled - c, r); }));
      const PixelBox upright{box.x0, doubled - box.y1 + 1, box.x1, doubled - box.y0 + 1};
      EXPECT_EQ(mirrored_top_bottom(region, about),
                region_by_pixel(upright, [&](int c, int r) { return contains(of, c, doubled - r); }));
      EXPECT_EQ(mirrored_left_right(mirrored_left_right(region, about), about), region);
      EXPECT_EQ(mirrored_top_bottom(mirrored_top_bottom(region, about), about), region);
    }
    EXPECT_EQ(mirrored_left_right(mirrored_top_bottom(region, 0), 0), reflected(region));
  }
  EXPECT_DEATH(mirrored_left_right(Region{}, .25), "on a pixel or between two");
  EXPECT_DEATH(mirrored_left_right(Region::from_box({0, 0, 1, 1}), 20000), "16 bit");
  EXPECT_DEATH(mirrored_top_bottom(Region::from_box({0, 0, 1, 1}), -20000), "16 bit");
}

TEST(Zoom, AsksThePixelThatHoldsTheCentreScaledBack) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    const auto [region, box] = random_case(seed);
    const Region& of = region;
    for (const ZoomFactors factors :
         {ZoomFactors{1, 1}, {2, 3}, {.5, .5}, {1.7, .6}, {.37, 2.5}, {1. / 3, 1. / 7}, {.01, .01}}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", factors " << factors.columns << ", " << factors.rows);
      const PixelBox window{int(box.x0 * factors.columns) - 2, int(box.y0 * factors.rows) - 2,
                            int(box.x1 * factors.columns) + 2, int(box.y1 * factors.rows) + 2};
      EXPECT_EQ(zoomed(region, factors), region_by_pixel(window, [&](int c, int r) {
                  return contains(of, int(std::floor((c + .5) / factors.columns)),
                                  int(std::floor((r + .5) / factors.rows)));
                }));
    }
  }
}

TEST(Zoom, WholeFactorsRepeatPixelsAndComeBack) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    const Region large = zoomed(region, {3, 5});
    EXPECT_EQ(area(large), 15 * area(region));
    EXPECT_EQ(zoomed(large, {1. / 3, 1. / 5}), region);
    EXPECT_EQ(zoomed(region, {1, 1}), region);
  }
  EXPECT_DEATH(zoomed(Region::from_box({0, 0, 100, 1}), {400, 1}), "16 bit");
  EXPECT_DEATH(zoomed(Region::from_box({0, 0, 100, 1}), {1e300, 1}), "16 bit");
  EXPECT_DEATH(zoomed(Region{}, {0, 1}), "positive");
}

}  // namespace
}  // namespace tassilo
