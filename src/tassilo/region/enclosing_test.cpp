#include "tassilo/region/enclosing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/features.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(SmallestRectangle, HoldsAllCornersOfTheHullAndNoOtherAngleIsSmaller) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    if (region.empty()) continue;
    const RotatedRectangle rectangle = smallest_rectangle(region);
    const PixelPoint along{std::cos(rectangle.phi), -std::sin(rectangle.phi)};
    EXPECT_GE(rectangle.half_length, rectangle.half_width);
    EXPECT_GT(rectangle.phi, -kPi / 2);
    EXPECT_LE(rectangle.phi, kPi / 2);
    const auto hull = convex_hull(region);
    double reach_along = 0, reach_across = 0;
    for (const PixelPoint& p : hull) {
      reach_along = std::max(reach_along, std::abs(dot(along, p - rectangle.center)));
      reach_across = std::max(reach_across, std::abs(cross(along, p - rectangle.center)));
    }
    EXPECT_NEAR(reach_along, rectangle.half_length, 1e-9);
    EXPECT_NEAR(reach_across, rectangle.half_width, 1e-9);
    const double area = 4 * rectangle.half_length * rectangle.half_width;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const PixelPoint side = hull[(i + 1) % hull.size()] - hull[i];
      if (norm(side) == 0) continue;
      std::vector<double> dots, crosses;
      for (const PixelPoint& p : hull) {
        dots.push_back(dot(side, p));
        crosses.push_back(cross(side, p));
      }
      const auto [d0, d1] = std::ranges::minmax(dots);
      const auto [c0, c1] = std::ranges::minmax(crosses);
      EXPECT_GE((d1 - d0) * (c1 - c0) / dot(side, side), area * (1 - 1e-12));
    }
  }
}

TEST(SmallestRectangle, OfKnownShapes) {
  const RotatedRectangle flat = smallest_rectangle(Region::from_box({10, 20, 31, 25}));
  EXPECT_EQ(flat.center, (PixelPoint{20, 22}));
  EXPECT_DOUBLE_EQ(flat.half_length, 10);
  EXPECT_DOUBLE_EQ(flat.half_width, 2);
  EXPECT_DOUBLE_EQ(flat.phi, 0);
  EXPECT_DOUBLE_EQ(smallest_rectangle(rectangle(1, 9)).phi, kPi / 2);
  EXPECT_DOUBLE_EQ(smallest_rectangle(rectangle(5, 5)).phi, 0);
  const RotatedRectangle slanted = smallest_rectangle(Region::from_runs({{0, 0, 1}, {-1, 1, 2}, {-2, 2, 3}}));
  EXPECT_NEAR(slanted.phi, kPi / 4, 1e-12) << "up to the right";
  EXPECT_NEAR(slanted.half_length, std::sqrt(2.), 1e-12);
  EXPECT_EQ(smallest_rectangle(rectangle(1, 1)).half_length, 0);
  EXPECT_EQ(smallest_rectangle(Region{}).half_length, 0);
}

TEST(SmallestCircle, HoldsAllAndIsHeldByItsPixels) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    if (region.empty()) continue;
    const Circle circle = smallest_circle(region);
    std::vector<double> angles;  // of the pixels on it
    for (const PixelPoint& p : convex_hull(region)) {
      EXPECT_LE(distance(p, circle.center), circle.radius * (1 + 1e-12));
      if (distance(p, circle.center) > circle.radius - 1e-7) angles.push_back(bearing(p - circle.center));
    }
    // It is the smallest when no half turn is free of pixels on it.
    if (circle.radius == 0) continue;
    std::ranges::sort(angles);
    ASSERT_GE(angles.size(), 2u);
    double gap = angles.front() + 2 * kPi - angles.back();
    for (std::size_t i = 1; i < angles.size(); ++i) gap = std::max(gap, angles[i] - angles[i - 1]);
    EXPECT_LE(gap, kPi + 1e-6);
  }
}

TEST(SmallestCircle, OfKnownShapes) {
  const Circle around = smallest_circle(translated(disc(25), {300, -200}));
  EXPECT_NEAR(around.radius, 25, 1e-9);
  EXPECT_NEAR(around.center.x, 300, 1e-9);
  EXPECT_NEAR(around.center.y, -200, 1e-9);
  EXPECT_NEAR(smallest_circle(Region::from_box({-30000, -30000, 30001, 30001})).radius, 30000 * std::sqrt(2.), 1e-6);
  EXPECT_EQ(smallest_circle(rectangle(1, 1)).radius, 0);
  EXPECT_EQ(smallest_circle(rectangle(9, 1)).radius, 4);
  EXPECT_EQ(smallest_circle(Region{}).radius, 0);
}

TEST(ConvexRegion, HoldsTheRegionIsConvexAndSmallest) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const Region filled = convex_region(region);
    EXPECT_EQ(area(filled), convex_area(region));
    EXPECT_TRUE(difference(region, filled).empty());
    EXPECT_EQ(convex_region(filled), filled);
    EXPECT_EQ(convex_hull(filled), convex_hull(region));
    const auto hull = convex_hull(region);
    for (const PixelRun& run : filled.runs())
      for (int c = run.begin; c < run.end; ++c)
        for (std::size_t i = 0; i < hull.size(); ++i)
          ASSERT_GE(cross(hull[(i + 1) % hull.size()] - hull[i], PixelPoint{double(c), double(run.row)} - hull[i]), 0);
  }
  const Region wide = Region::from_runs({{-32768, -32768, -32767}, {32767, 32766, 32767}, {0, -32768, 32767}});
  EXPECT_EQ(area(convex_region(wide)), convex_area(wide));
}

}  // namespace
}  // namespace tassilo
