#include "tassilo/region/outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tassilo/region/algebra.h"
#include "tassilo/region/features.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

double twice_area(const Outline& outline) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.corners.size(); ++i)
    sum += cross(outline.corners[i], outline.corners[(i + 1) % outline.corners.size()]);
  return sum;
}

double length(const Outline& outline) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.corners.size(); ++i)
    sum += distance(outline.corners[i], outline.corners[(i + 1) % outline.corners.size()]);
  return sum;
}

TEST(Outlines, GiveTheRegionBack) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    const auto [region, box] = random_case(seed);
    for (const Connectivity foreground : {Connectivity::four, Connectivity::eight}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", eight " << (foreground == Connectivity::eight));
      const auto found = outlines(region, foreground);
      EXPECT_EQ(region_from_outlines(found, box), region);
      const auto parts = components(region, foreground);
      EXPECT_EQ(std::ranges::count(found, false, &Outline::is_hole), std::ssize(parts));
      EXPECT_EQ(std::ranges::count(found, true, &Outline::is_hole), hole_count(region, foreground));
      double sum = 0;
      std::size_t outer = 0;
      for (const Outline& outline : found) {
        EXPECT_EQ(twice_area(outline) < 0, outline.is_hole) << "outer ones run clockwise on the screen";
        sum += twice_area(outline);
        const auto& corners = outline.corners;
        for (std::size_t i = 0; i < corners.size(); ++i) {
          const PixelPoint step = corners[(i + 1) % corners.size()] - corners[i];
          const PixelPoint next = corners[(i + 2) % corners.size()] - corners[(i + 1) % corners.size()];
          EXPECT_EQ(dot(step, next), 0) << "a quarter turn at each corner";
          EXPECT_NE(norm(step), 0);
        }
        if (outline.is_hole) continue;
        // The k-th outer one goes around the k-th component.
        const PixelBox around = bounding_box(parts[outer++]);
        const auto [left, right] = std::ranges::minmax(corners, {}, &PixelPoint::x);
        const auto [top, bottom] = std::ranges::minmax(corners, {}, &PixelPoint::y);
        EXPECT_EQ(left.x, around.x0 - .5);
        EXPECT_EQ(right.x, around.x1 - .5);
        EXPECT_EQ(top.y, around.y0 - .5);
        EXPECT_EQ(bottom.y, around.y1 - .5);
      }
      EXPECT_EQ(sum, 2. * static_cast<double>(area(region)));
    }
  }
}

TEST(Outlines, OfTwoPixelsThatTouchByACorner) {
  for (const Region& region : {Region::from_runs({{0, 0, 1}, {1, 1, 2}}), Region::from_runs({{0, 1, 2}, {1, 0, 1}})}) {
    EXPECT_EQ(outlines(region, Connectivity::eight).size(), 1u);
    EXPECT_EQ(outlines(region, Connectivity::four).size(), 2u);
    EXPECT_EQ(outlines(region).front().corners.size(), 8u);
  }
  const auto square = outlines(Region::from_box({2, 3, 5, 4}));
  ASSERT_EQ(square.size(), 1u);
  EXPECT_EQ(square.front().corners, (RecycledVector<PixelPoint>{{1.5, 2.5}, {4.5, 2.5}, {4.5, 3.5}, {1.5, 3.5}}));
  EXPECT_TRUE(outlines(Region{}).empty());
  EXPECT_EQ(outlines(Region::from_box({-32768, -32768, 32767, -32767})).size(), 1u);
}

TEST(CenterOutlines, WalkOnBorderPixelsAsLongAsTheContour) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    double outer = 0;
    const auto found = center_outlines(region);
    for (const Outline& outline : found) {
      if (!outline.is_hole) outer += length(outline);
      const auto& corners = outline.corners;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        EXPECT_TRUE(contains(region, int(corners[i].x), int(corners[i].y)));
        const PixelPoint step = corners[(i + 1) % corners.size()] - corners[i];
        EXPECT_TRUE(step.x == 0 || step.y == 0 || std::abs(step.x) == std::abs(step.y));
      }
    }
    EXPECT_NEAR(outer, contour_length(region), 1e-9);
    EXPECT_EQ(found.size(), components(region).size() + static_cast<std::size_t>(hole_count(region)));
  }
  EXPECT_EQ(center_outlines(rectangle(1, 1)).front().corners, (RecycledVector<PixelPoint>{{0, 0}}));
  EXPECT_EQ(center_outlines(rectangle(3, 1)).front().corners, (RecycledVector<PixelPoint>{{-1, 0}, {1, 0}}));
  EXPECT_EQ(center_outlines(rectangle(3, 3)).front().corners,
            (RecycledVector<PixelPoint>{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}));
}

}  // namespace
}  // namespace tassilo
