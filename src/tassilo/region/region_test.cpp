#include "tassilo/region/region.h"

#include <gtest/gtest.h>

namespace tassilo {
namespace {

TEST(Region, JoinsOverlappingAndTouchingRuns) {
  const Region region = Region::from_runs({{1, 5, 9}, {0, 3, 3}, {1, 1, 3}, {1, 3, 6}, {2, 9, 12}});
  const RunVector expected{{1, 1, 9}, {2, 9, 12}};
  EXPECT_TRUE(std::ranges::equal(region.runs(), expected));
  EXPECT_EQ(area(region), 11);
  EXPECT_EQ(bounding_box(region), (PixelBox{1, 1, 12, 3}));
  EXPECT_TRUE(contains(region, 8, 1));
  EXPECT_FALSE(contains(region, 9, 1));
  EXPECT_FALSE(contains(region, 8, 2));
}

TEST(Region, EmptyHasNothing) {
  EXPECT_TRUE(Region{}.empty());
  EXPECT_EQ(area(Region{}), 0);
  EXPECT_TRUE(bounding_box(Region{}).empty());
  EXPECT_FALSE(contains(Region{}, 0, 0));
}

}  // namespace
}  // namespace tassilo
