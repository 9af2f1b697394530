#include "tassilo/contour/boundary_contours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <utility>

#include "tassilo/contour/test_regions.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/features.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

constexpr unsigned kCases = 300;

/// Twice the area around which the points run, > 0 clockwise on the screen.
double twice_area(const Contour& contour) {
  double sum = 0;
  for (std::size_t i = 0; i < contour.points.size(); ++i)
    sum += cross(contour.points[i], contour.points[(i + 1) % contour.points.size()]);
  return sum;
}

TEST(BoundaryContours, AreAsManyAsPartsAndHoles) {
  for (unsigned seed = 0; seed < kCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = noise_region(seed);
    const auto borders = boundary_contours(region);
    const auto inner = std::count_if(borders.begin(), borders.end(), [](const auto& border) { return border.hole; });
    EXPECT_EQ(inner, hole_count(region));
    EXPECT_EQ(std::ssize(borders) - inner, label_runs(region).count);
  }
}

TEST(BoundaryContours, HaveAllBorderPixelsAndNoOthers) {
  for (unsigned seed = 0; seed < kCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = noise_region(seed);
    std::set<std::pair<double, double>> seen, border;
    for (const BoundaryContour& contour : boundary_contours(region))
      for (const PixelPoint point : contour.contour.points) seen.insert({point.y, point.x});
    // A border pixel has background beside it.
    const Region border_pixels = difference(region, erosion(region, disc(1)));
    for (const PixelRun& run : border_pixels.runs())
      for (int c = run.begin; c < run.end; ++c) border.insert({double(run.row), double(c)});
    EXPECT_EQ(seen, border);
  }
}

TEST(BoundaryContours, GoFromPixelToNeighborWithTheRegionToTheRight) {
  for (unsigned seed = 0; seed < kCases; ++seed) {
    SCOPED_TRACE(seed);
    for (const BoundaryContour& border : boundary_contours(noise_region(seed))) {
      const auto& points = border.contour.points;
      EXPECT_TRUE(border.contour.closed);
      for (std::size_t i = 0; i < points.size() && points.size() > 1; ++i) {
        const double step = distance(points[i], points[(i + 1) % points.size()]);
        ASSERT_TRUE(step == 1 || step == std::numbers::sqrt2);
      }
      if (border.hole)
        ASSERT_LT(twice_area(border.contour), 0);
      else
        ASSERT_GE(twice_area(border.contour), 0);
    }
  }
}

TEST(BoundaryContours, OuterOnesAreAsLongAsTheRegionsContour) {
  for (unsigned seed = 0; seed < kCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = noise_region(seed);
    double sum = 0;
    for (const BoundaryContour& border : boundary_contours(region))
      if (!border.hole) sum += length(border.contour);
    EXPECT_NEAR(sum, contour_length(region), 1e-9);
  }
}

TEST(BoundaryContours, OfKnownShapes) {
  EXPECT_TRUE(boundary_contours({}).empty());
  const auto one = boundary_contours(Region::from_box({-3, 4, -2, 5}));
  ASSERT_EQ(one.size(), 1u);
  ASSERT_EQ(one[0].contour.points.size(), 1u);
  EXPECT_EQ(one[0].contour.points[0], (PixelPoint{-3, 4}));

  const auto square = boundary_contours(Region::from_box({0, 0, 3, 2}));
  ASSERT_EQ(square.size(), 1u);
  const RecycledVector<PixelPoint> clockwise{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}};
  EXPECT_EQ(square[0].contour.points, clockwise);

  const auto ring = boundary_contours(difference(rectangle(5, 5), rectangle(1, 1)));
  ASSERT_EQ(ring.size(), 2u);
  EXPECT_FALSE(ring[0].hole);
  EXPECT_TRUE(ring[1].hole);
  EXPECT_DOUBLE_EQ(length(ring[1].contour), 4 * std::numbers::sqrt2) << "around the hole, past its corners";
}

}  // namespace
}  // namespace tassilo
