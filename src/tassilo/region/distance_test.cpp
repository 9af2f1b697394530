#include "tassilo/region/distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/elements.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

constexpr DistanceMetric kMetrics[] = {DistanceMetric::euclidean_squared, DistanceMetric::chessboard,
                                       DistanceMetric::city_block};

std::int32_t between(PixelShift step, DistanceMetric metric) {
  const int dc = std::abs(step.columns), dr = std::abs(step.rows);
  switch (metric) {
    case DistanceMetric::euclidean_squared:
      return dc * dc + dr * dr;
    case DistanceMetric::chessboard:
      return std::max(dc, dr);
    case DistanceMetric::city_block:
      return dc + dr;
  }
  return -1;
}

std::int32_t nearest(const std::vector<PixelShift>& pixels, PixelShift from, DistanceMetric metric) {
  std::int32_t best = DistanceImage::kNone;
  for (const PixelShift& p : pixels)
    best = std::min(best, between({p.columns - from.columns, p.rows - from.rows}, metric));
  return best;
}

std::vector<PixelShift> pixels_of(const Region& region) {
  std::vector<PixelShift> pixels;
  for (const PixelRun& run : region.runs())
    for (int c = run.begin; c < run.end; ++c) pixels.push_back({c, run.row});
  return pixels;
}

TEST(Distance, IsThatOfTheNearestPixel) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    const auto [region, box] = random_case(seed);
    // Wider than the region, and one that cuts it.
    const PixelBox inner{box.x0 + box.width() / 3, box.y0 + box.height() / 4, box.x1 + 2, box.y1};
    for (const PixelBox& window : {PixelBox{box.x0 - 5, box.y0 - 3, box.x1 + 2, box.y1 + 9}, inner}) {
      const std::vector<PixelShift> in = pixels_of(region);
      const PixelBox around{box.x0 - 1, box.y0 - 1, box.x1 + 1, box.y1 + 1};
      const std::vector<PixelShift> out = pixels_of(complement(region, around));
      for (const DistanceMetric metric : kMetrics) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", metric " << static_cast<int>(metric));
        const DistanceImage to = distance_to(region, window, metric), inside = distance_inside(region, window, metric);
        ASSERT_EQ(std::ssize(to.values), window.area());
        ASSERT_EQ(std::ssize(inside.values), window.area());
        for (int r = window.y0; r < window.y1; ++r)
          for (int c = window.x0; c < window.x1; ++c) {
            ASSERT_EQ(to.at(c, r), nearest(in, {c, r}, metric)) << c << ", " << r;
            ASSERT_EQ(inside.at(c, r), contains(region, c, r) ? nearest(out, {c, r}, metric) : 0) << c << ", " << r;
          }
      }
    }
  }
}

TEST(Distance, LevelsAreDilationsAndErosions) {
  for (unsigned seed = 0; seed < kRandomCases; seed += 3) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const PixelBox window{box.x0 - 6, box.y0 - 6, box.x1 + 6, box.y1 + 6};
    for (const int radius : {1, 2, 5}) {
      const Region elements[] = {disc(radius), rectangle(2 * radius + 1, 2 * radius + 1), diamond(radius)};
      for (const DistanceMetric metric : kMetrics) {
        const Region& element = elements[static_cast<std::size_t>(metric)];
        const int reach = metric == DistanceMetric::euclidean_squared ? radius * radius : radius;
        const DistanceImage to = distance_to(region, window, metric), inside = distance_inside(region, window, metric);
        EXPECT_EQ(dilation(region, element),
                  region_by_pixel(window, [&](int c, int r) { return to.at(c, r) <= reach; }));
        EXPECT_EQ(erosion(region, element),
                  region_by_pixel(window, [&](int c, int r) { return inside.at(c, r) > reach; }));
      }
    }
  }
}

TEST(Distance, IsTheSameNearAndFar) {
  // Columns with pixels in easy reach, with none, and some where reach ends within a row or a column.
  const Region region = Region::from_runs(
      {{0, 0, 3}, {9, 1, 2}, {31, 5, 6}, {40, 0, 1}, {64, 17, 18}, {66, 32, 40}, {99, 70, 75}, {140, 3, 4}});
  const PixelBox window{-3, -2, 91, 121};
  const std::vector<PixelShift> in = pixels_of(region);
  for (const DistanceMetric metric : kMetrics) {
    const DistanceImage to = distance_to(region, window, metric);
    for (int r = window.y0; r < window.y1; ++r)
      for (int c = window.x0; c < window.x1; ++c) ASSERT_EQ(to.at(c, r), nearest(in, {c, r}, metric)) << c << ", " << r;
  }
}

TEST(Distance, OfFarAwayPixelsDoesNotWrap) {
  const Region corner = Region::from_box({-16384, -16384, -16383, -16383});
  const DistanceImage far = distance_to(corner, {16380, 16383, 16384, 16384});
  EXPECT_EQ(far.at(16383, 16383), 2147352578);
  EXPECT_EQ(distance_to(corner, {16383, 16383, 16384, 16384}, DistanceMetric::city_block).values[0], 65534);
  EXPECT_DEATH(distance_to(corner, {16383, 16383, 16385, 16384}), "32768 pixels");
}

TEST(Distance, OfNothing) {
  EXPECT_EQ(distance_to(Region{}, {0, 0, 2, 1}).values, (RecycledVector<std::int32_t>(2, DistanceImage::kNone)));
  EXPECT_EQ(distance_inside(Region{}, {0, 0, 2, 1}).values, (RecycledVector<std::int32_t>(2, 0)));
  EXPECT_TRUE(distance_to(rectangle(3, 3), {}).values.empty());
  EXPECT_TRUE(distance_inside(rectangle(3, 3), {}).values.empty());
}

}  // namespace
}  // namespace tassilo
