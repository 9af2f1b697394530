#include "tassilo/region/feret.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tassilo/region/algebra.h"
#include "tassilo/region/enclosing.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Diameter, IsTheLargestDistanceOfAllPairs) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    if (region.empty()) continue;
    double longest = 0;
    for (const PixelRun& a : region.runs())
      for (const PixelRun& b : region.runs())
        longest = std::max(longest, std::hypot(std::max(b.end - 1 - a.begin, a.end - 1 - b.begin), b.row - a.row));
    const Diameter found = diameter(region);
    EXPECT_DOUBLE_EQ(found.length, longest);
    EXPECT_DOUBLE_EQ(distance(found.first, found.second), longest);
    for (const PixelPoint& end : {found.first, found.second}) EXPECT_TRUE(contains(region, int(end.x), int(end.y)));
    EXPECT_TRUE(found.first.y < found.second.y || (found.first.y == found.second.y && found.first.x <= found.second.x));
  }
}

TEST(Feret, IsTheExtentInADirectionAndItsExtremes) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    const FeretDiameters feret = feret_diameters(region);
    EXPECT_DOUBLE_EQ(feret.max.length, diameter(region).length);
    for (int step = 0; step < 180; ++step) {
      const double angle = step * kPi / 180, length = feret_diameter(region, angle);
      EXPECT_LE(length, feret.max.length + 1e-9);
      EXPECT_GE(length, feret.min.length - 1e-9);
      EXPECT_NEAR(feret_diameter(region, angle + kPi), length, 1e-9);
      EXPECT_NEAR(feret_diameter(convex_region(region), angle), length, 1e-9);
    }
    EXPECT_NEAR(feret_diameter(region, feret.max.angle), feret.max.length, 1e-9);
    EXPECT_NEAR(feret_diameter(region, feret.min.angle), feret.min.length, 1e-9);
    if (region.empty()) continue;
    const PixelBox box = bounding_box(region);
    EXPECT_NEAR(feret_diameter(region, 0), box.width() - 1, 1e-9);
    EXPECT_NEAR(feret_diameter(region, kPi / 2), box.height() - 1, 1e-9);
  }
}

TEST(Feret, OfKnownShapes) {
  const FeretDiameters box = feret_diameters(rectangle(31, 11));
  EXPECT_DOUBLE_EQ(box.min.length, 10);
  EXPECT_DOUBLE_EQ(box.min.angle, kPi / 2);
  EXPECT_DOUBLE_EQ(box.max.length, std::hypot(30, 10));
  EXPECT_NEAR(feret_diameters(disc(50)).min.length, 100, 1.1);
  EXPECT_EQ(feret_diameters(rectangle(9, 1)).min.length, 0);
  EXPECT_EQ(feret_diameters(rectangle(1, 1)).max.length, 0);
  EXPECT_EQ(feret_diameters(Region{}).min.length, 0);
  EXPECT_EQ(diameter(Region{}).length, 0);
}

}  // namespace
}  // namespace tassilo
