#include "tassilo/region/inscribed.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

bool fits(const Region& shape, PixelPoint center, const Region& region) {
  const PixelShift shift{static_cast<int>(center.x), static_cast<int>(center.y)};
  return difference(translated(shape, shift), region).empty();
}

TEST(InnerCircle, FitsAndNoLargerOneDoes) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = closing(random_case(seed).region, rectangle(3, 3));
    if (region.empty()) continue;
    const Circle circle = inner_circle(region);
    EXPECT_TRUE(fits(disc(circle.radius), circle.center, region));
    EXPECT_TRUE(erosion(region, disc(circle.radius + .5 + 1e-9)).empty());
    // The first of all places where so large a disc fits.
    const Region places = erosion(region, disc(circle.radius + .5 - 1e-9));
    ASSERT_FALSE(places.empty());
    EXPECT_EQ(circle.center, (PixelPoint{double(places.runs().front().begin), double(places.runs().front().row)}));
  }
  EXPECT_DOUBLE_EQ(inner_circle(rectangle(11, 21)).radius, 5.5);
  EXPECT_EQ(inner_circle(Region{}).radius, 0);
}

/// The largest box by trying all.
std::int64_t largest_box_area(const Region& region, const PixelBox& box) {
  std::int64_t largest = 0;
  for (int y0 = box.y0; y0 < box.y1; ++y0)
    for (int y1 = y0 + 1; y1 <= box.y1; ++y1) {
      // Columns that are in the region from y0 to y1 are where a line that high fits.
      const Region columns =
          clipped(erosion(region, translated(rectangle(1, y1 - y0), {0, (y1 - y0) / 2})), {box.x0, y0, box.x1, y0 + 1});
      for (const PixelRun& run : columns.runs()) largest = std::max(largest, std::int64_t{run.length()} * (y1 - y0));
    }
  return largest;
}

TEST(InnerRectangle, FitsAndNoLargerOneDoes) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const PixelBox found = inner_rectangle(region);
    EXPECT_TRUE(difference(Region::from_box(found), region).empty());
    EXPECT_EQ(found.area(), largest_box_area(region, box));
  }
  EXPECT_EQ(inner_rectangle(Region::from_box({-7, 3, 20, 9})), (PixelBox{-7, 3, 20, 9}));
  EXPECT_TRUE(inner_rectangle(Region{}).empty());
}

}  // namespace
}  // namespace tassilo
