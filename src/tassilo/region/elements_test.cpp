#include "tassilo/region/elements.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/features.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

TEST(Diamond, IsSoManyStepsInFourDirections) {
  Region grown = rectangle(1, 1);
  for (int radius = 0; radius < 12; ++radius) {
    EXPECT_EQ(diamond(radius), grown);
    grown = dilation(grown, diamond(1));
  }
  EXPECT_DEATH(diamond(-1), "0 or more");
}

TEST(Octagon, LiesBetweenDiscAndSquare) {
  for (int radius = 0; radius < 40; ++radius) {
    SCOPED_TRACE(radius);
    const Region shape = octagon(radius);
    const int steps = static_cast<int>(std::lround(radius * std::sqrt(2.)));
    EXPECT_EQ(shape, region_by_pixel({-50, -50, 51, 51}, [&](int c, int r) {
                return std::abs(c) <= radius && std::abs(r) <= radius && std::abs(c) + std::abs(r) <= steps;
              }));
    EXPECT_EQ(transposed(shape), shape);
    EXPECT_EQ(reflected(shape), shape);
    EXPECT_EQ(convexity(shape), 1);
    EXPECT_TRUE(difference(disc(radius * .99 - .5 < 0 ? 0 : radius * .99 - .5), shape).empty());
  }
  EXPECT_EQ(octagon(1), diamond(1));
  EXPECT_DEATH(octagon(40000), "16 bit");
}

TEST(LineElement, IsThinConnectedAndSymmetric) {
  for (const double length : {1., 2., 3., 4.5, 9., 20., 61.})
    for (int step = -20; step < 20; ++step) {
      SCOPED_TRACE(testing::Message() << "length " << length << ", step " << step);
      const double angle = step * std::numbers::pi / 20 + .01;
      const Region line = line_element({length, angle});
      const PixelBox box = bounding_box(line);
      EXPECT_EQ(area(line), std::max(box.width(), box.height())) << "one pixel for each";
      EXPECT_EQ(label_runs(line).count, 1);
      EXPECT_EQ(reflected(line), line);
      EXPECT_TRUE(contains(line, 0, 0));
      EXPECT_EQ(line_element({length, angle + std::numbers::pi}), line);
      for (const PixelRun& run : line.runs())
        for (int c = run.begin; c < run.end; ++c)
          EXPECT_LE(std::abs(c * std::sin(angle) + run.row * std::cos(angle)), 1.5) << "near the ideal line";
    }
  EXPECT_EQ(line_element({5, 0}), rectangle(5, 1));
  EXPECT_EQ(line_element({5, std::numbers::pi / 2}), rectangle(1, 5));
  EXPECT_TRUE(contains(line_element({9, std::numbers::pi / 4}), 2, -2)) << "up to the right";
  EXPECT_DEATH(line_element({.5, 0}), "1 or more");
}

}  // namespace
}  // namespace tassilo
