#include "tassilo/region/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tassilo/region/algebra.h"
#include "tassilo/region/inscribed.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

constexpr double kPi = std::numbers::pi;
const PixelBox kWindow{-60, -60, 61, 61};

TEST(Shapes, HoldThePixelCentresInside) {
  std::mt19937 random(1);
  const auto number = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  for (int k = 0; k < 200; ++k) {
    SCOPED_TRACE(k);
    const PixelPoint center{number(-10, 10), number(-10, 10)};
    const double a = number(0, 30), b = number(0, k % 2 ? 3 : 30), phi = number(-kPi, kPi);
    const PixelPoint along{std::cos(phi), -std::sin(phi)};
    const auto pixels = [&](auto holds) {
      return region_by_pixel(kWindow, [&](int c, int r) {
        const PixelPoint p = PixelPoint{double(c), double(r)} - center;
        return holds(dot(along, p), cross(along, p));
      });
    };
    EXPECT_EQ(circle_region({center, a}), pixels([&](double x, double y) { return std::hypot(x, y) <= a; }));
    EXPECT_EQ(ellipse_region(center, {a, b, phi}),
              pixels([&](double x, double y) { return std::hypot(x / a, y / b) <= 1; }));
    EXPECT_EQ(rectangle_region({center, a, b, phi}),
              pixels([&](double x, double y) { return std::abs(x) <= a && std::abs(y) <= b; }));
  }
}

TEST(Shapes, FittedAroundARegionHoldIt) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    if (region.empty()) continue;
    EXPECT_TRUE(difference(region, circle_region(smallest_circle(region))).empty());
    EXPECT_TRUE(difference(region, rectangle_region(smallest_rectangle(region))).empty());
    EXPECT_TRUE(difference(circle_region(inner_circle(region)), region).empty());
  }
}

TEST(Shapes, OfKnownSizes) {
  for (const double radius : {0., 1., 3.5, 12.})
    EXPECT_EQ(circle_region({{40, -7}, radius}), translated(disc(radius), {40, -7}));
  EXPECT_EQ(rectangle_region({{2, 1}, 5, 3, 0}), Region::from_box({-3, -2, 8, 5}));
  EXPECT_EQ(rectangle_region({{2, 1}, 5, 3, kPi / 2}), Region::from_box({-1, -4, 6, 7}));
  EXPECT_EQ(ellipse_region({0, 0}, {7, 7, .3}), disc(7));
  EXPECT_EQ(ellipse_region({0, 0}, {7, 0, kPi / 2}), rectangle(1, 15));
  EXPECT_TRUE(circle_region({{.5, .5}, .1}).empty());
  EXPECT_DEATH(circle_region({{0, 0}, 40000}), "16 bit");
  EXPECT_DEATH(circle_region({{0, 0}, -1}), "not negative");
}

}  // namespace
}  // namespace tassilo
