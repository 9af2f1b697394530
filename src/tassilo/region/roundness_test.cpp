#include "tassilo/region/roundness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tassilo/region/features.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/residue.h"
#include "tassilo/region/shapes.h"

namespace tassilo {
namespace {

TEST(Roundness, EqualsTheMeansOverTheBoundary) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    if (region.empty()) continue;
    const Region boundary = inner_boundary(region);
    const PixelPoint center = shape_features(region).center;
    std::vector<double> distances;
    for (int r = box.y0; r < box.y1; ++r)
      for (int c = box.x0; c < box.x1; ++c)
        if (contains(boundary, c, r)) distances.push_back(distance(center, {double(c), double(r)}));
    double mean = 0, variance = 0;
    for (const double d : distances) mean += d / static_cast<double>(distances.size());
    for (const double d : distances) variance += (d - mean) * (d - mean) / static_cast<double>(distances.size());
    const Roundness found = roundness(region);
    EXPECT_NEAR(found.distance, mean, 1e-9);
    EXPECT_NEAR(found.deviation, std::sqrt(variance), 1e-4);
    EXPECT_GE(found.roundness, 0);
    EXPECT_LE(found.roundness, 1);
  }
}

TEST(Roundness, OfKnownShapes) {
  EXPECT_GT(roundness(disc(40)).roundness, .98);
  EXPECT_NEAR(roundness(disc(40)).distance, 40, .6);
  EXPECT_NEAR(roundness(rectangle(101, 101)).sides, 4, .3);
  EXPECT_NEAR(roundness(rectangle_region({{0, 0}, 50, 50, .4})).sides, 4, .3);
  EXPECT_LT(roundness(rectangle(101, 11)).roundness, .6);
  EXPECT_EQ(roundness(rectangle(1, 1)).roundness, 0);
  EXPECT_EQ(roundness(rectangle(1, 1)).sides, 0);
  EXPECT_EQ(roundness(Region{}).distance, 0);
}

}  // namespace
}  // namespace tassilo
