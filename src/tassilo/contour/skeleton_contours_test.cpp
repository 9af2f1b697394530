#include "tassilo/contour/skeleton_contours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "tassilo/base/error.h"
#include "tassilo/contour/test_regions.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/raster.h"
#include "tassilo/region/skeleton.h"

namespace tassilo {
namespace {

using Pixel = std::pair<int, int>;  // (row, column)

Pixel pixel_at(PixelPoint point) { return {static_cast<int>(point.y), static_cast<int>(point.x)}; }

TEST(SkeletonContours, HaveEveryPixelOnceOrInAJunction) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const Region noise = noise_region(seed), region = seed % 3 == 0 ? noise : skeleton(noise);
    const SkeletonContours result = skeleton_contours(region);
    std::map<Pixel, int> in_contours, in_junctions;
    for (const Junction& junction : result.junctions)
      for (const PixelPoint point : junction.pixels) ++in_junctions[pixel_at(point)];
    for (const SkeletonContour& stretch : result.contours) {
      const auto& points = stretch.contour.points;
      ASSERT_FALSE(points.empty());
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (i > 0) {
          ASSERT_LE(distance(points[i - 1], points[i]), 1.5);
        }
        const bool at_junction = in_junctions.contains(pixel_at(points[i]));
        const bool may = (i == 0 && stretch.from >= 0) || (i + 1 == points.size() && stretch.to >= 0);
        ASSERT_EQ(at_junction, may);
        if (!at_junction) ++in_contours[pixel_at(points[i])];
      }
      if (stretch.contour.closed) {
        ASSERT_LE(distance(points.front(), points.back()), 1.5);
        ASSERT_EQ(stretch.from + stretch.to, -2);
      }
      for (const auto& [index, end] : {std::pair(stretch.from, points.front()), std::pair(stretch.to, points.back())})
        if (index >= 0) {
          const auto& pixels = result.junctions[static_cast<std::size_t>(index)].pixels;
          ASSERT_NE(std::find(pixels.begin(), pixels.end(), end), pixels.end());
        }
    }
    for (const auto& [pixel, times] : in_contours) ASSERT_EQ(times, 1);
    for (const auto& [pixel, times] : in_junctions) ASSERT_EQ(times, 1);
    std::int64_t count = 0;
    for (const auto* pixels : {&in_contours, &in_junctions})
      for (const auto& [pixel, times] : *pixels) {
        ASSERT_TRUE(contains(region, pixel.second, pixel.first));
        ++count;
      }
    ASSERT_EQ(count, area(region));
  }
}

TEST(SkeletonContours, OfSimpleFigures) {
  EXPECT_TRUE(skeleton_contours({}).contours.empty());

  const SkeletonContours one = skeleton_contours(rectangle(1, 1));
  ASSERT_EQ(one.contours.size(), 1u);
  EXPECT_EQ(one.contours[0].contour.points.size(), 1u);
  EXPECT_TRUE(one.ends.empty() && one.junctions.empty());

  const SkeletonContours line = skeleton_contours(Region::from_box({-5, 3, 20, 4}));
  ASSERT_EQ(line.contours.size(), 1u);
  EXPECT_EQ(line.contours[0].contour.points.front(), (PixelPoint{-5, 3}));
  EXPECT_EQ(line.contours[0].contour.points.back(), (PixelPoint{19, 3}));
  EXPECT_EQ(line.ends.size(), 2u);

  const SkeletonContours ring = skeleton_contours(skeleton(difference(disc(20), disc(15))));
  ASSERT_EQ(ring.contours.size(), 1u);
  EXPECT_TRUE(ring.contours[0].contour.closed);
  EXPECT_NEAR(length(ring.contours[0].contour), 2 * 3.14159 * 17.5, 12);
  EXPECT_TRUE(ring.ends.empty() && ring.junctions.empty());

  // A corner of pixels that share edges is no junction.
  const SkeletonContours corner =
      skeleton_contours(union_of(Region::from_box({0, 0, 10, 1}), Region::from_box({0, 0, 1, 10})));
  ASSERT_EQ(corner.contours.size(), 1u);
  EXPECT_EQ(corner.contours[0].contour.points.size(), 19u);

  for (const bool crossing : {false, true}) {
    const Region cross = union_of(Region::from_box({-9, 0, 10, 1}), Region::from_box({0, crossing ? -9 : 0, 1, 10}));
    const SkeletonContours arms = skeleton_contours(cross);
    EXPECT_EQ(arms.contours.size(), crossing ? 4u : 3u);
    ASSERT_EQ(arms.junctions.size(), 1u);
    EXPECT_EQ(arms.junctions[0].center, (PixelPoint{0, 0}));
    EXPECT_EQ(arms.ends.size(), arms.contours.size());
    for (const SkeletonContour& arm : arms.contours) {
      EXPECT_EQ(arm.contour.points.size(), 10u);
      EXPECT_EQ(std::max(arm.from, arm.to), 0);
    }
  }
}

TEST(SkeletonContours, ShortOnesAreLeftOutOnDemand) {
  const Region region = skeleton(noise_region(3));
  const SkeletonContours all = skeleton_contours(region), longer = skeleton_contours(region, {.min_points = 4});
  const auto is_long = [](const SkeletonContour& stretch) { return stretch.contour.points.size() >= 4; };
  EXPECT_EQ(std::count_if(all.contours.begin(), all.contours.end(), is_long), std::ssize(longer.contours));
  EXPECT_LT(longer.contours.size(), all.contours.size());
  EXPECT_EQ(longer.junctions.size(), all.junctions.size());
  EXPECT_THROW(skeleton_contours(region, {.min_points = 0}), Error);
}

// A slanted band of any width: its skeleton's points come to lie on the middle line, without leaning to one side.
TEST(Centered, LiesInTheMiddleOfABand) {
  for (const double width : {4., 5., 6., 7., 8.5}) {
    SCOPED_TRACE(width);
    const PixelPoint p{20, 30}, q{140, 52};
    const PixelPoint along = (1 / distance(p, q)) * (q - p), across{-along.y, along.x};
    const PixelPoint half = width / 2 * across;
    const std::array corners{p - half, q - half, q + half, p + half};
    const Region band = region_from_polygon(corners, {0, 0, 200, 100});
    double sum = 0, raw = 0;
    int count = 0;
    for (const SkeletonContour& one : skeleton_contours(skeleton(band)).contours) {
      const Contour middle = centered(one.contour, band, 12);
      for (std::size_t k = 0; k < middle.points.size(); ++k) {
        const double place = dot(middle.points[k] - p, along);
        if (place < width || place > distance(p, q) - width) continue;  // the ends have corners
        EXPECT_LT(std::abs(dot(middle.points[k] - p, across)), 0.75);
        sum += dot(middle.points[k] - p, across);
        raw += dot(one.contour.points[k] - p, across);
        ++count;
      }
    }
    ASSERT_GT(count, 50);
    EXPECT_LT(std::abs(sum / count), 0.05) << "as the skeleton: " << raw / count;
  }
}

TEST(Centered, LeavesWhatIsOutsideOrFarFromBorders) {
  const Region block = Region::from_box({0, 0, 60, 60});
  const Contour contour{.points = {{30, 30}, {70, 70}, {2, 30}}};
  const Contour result = centered(contour, block, 5);
  EXPECT_EQ(result.points[0], contour.points[0]);
  EXPECT_EQ(result.points[1], contour.points[1]);
  EXPECT_EQ(result.points[2], contour.points[2]);
}

}  // namespace
}  // namespace tassilo
