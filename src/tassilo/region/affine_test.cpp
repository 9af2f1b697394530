#include "tassilo/region/affine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/transform.h"

namespace tassilo {
namespace {

constexpr double kPi = std::numbers::pi;

AffineMap inverse(const AffineMap& m) {
  const double det = m.xx * m.yy - m.xy * m.yx;
  const AffineMap turn{m.yy / det, -m.xy / det, 0, -m.yx / det, m.xx / det, 0};
  const PixelPoint origin = turn * PixelPoint{-m.x0, -m.y0};
  return {turn.xx, turn.xy, origin.x, turn.yx, turn.yy, origin.y};
}

TEST(Affine, AsksThePixelNearestToTheCentreMappedBack) {
  const AffineMap maps[] = {rotation_about({3.21, 1.37}, .713),
                            rotation_about({-11.3, 2.9}, -2.41),
                            {1.37, .21, 3.317, -.33, .71, 1.173},
                            {-.51, 0, 7.123, .1, 2.713, .441}};
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    const AffineMap& map = maps[seed / 4 % std::size(maps)];  // each map meets every kind of region
    const AffineMap back = inverse(map);
    EXPECT_EQ(mapped(region, map), region_by_pixel({-150, -150, 150, 150}, [&](int c, int r) {
                const PixelPoint p = back * PixelPoint{double(c), double(r)};
                return contains(region, int(std::floor(p.x + .5)), int(std::floor(p.y + .5)));
              }));
  }
}

TEST(Affine, WholeStepsAndQuarterTurnsAreExact) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    EXPECT_EQ(mapped(region, {}), region);
    EXPECT_EQ(mapped(region, {.x0 = 7, .y0 = -4}), translated(region, {7, -4}));
    EXPECT_EQ(mapped(region, {0, 1, 0, 1, 0, 0}), transposed(region));
    EXPECT_EQ(mapped(region, {-1, 0, 5, 0, 1, 0}), mirrored_left_right(region, 2.5));
    EXPECT_EQ(mapped(region, {3, 0, 1, 0, 2, .5}), zoomed(region, {3, 2})) << "pixel edges, not centres, are scaled";
    EXPECT_EQ(mapped(region, rotation_about({0, 0}, kPi)), reflected(region));
    // A quarter turn counter-clockwise takes "right" to "up".
    EXPECT_EQ(mapped(region, rotation_about({0, 0}, kPi / 2)), mirrored_top_bottom(transposed(region), 0));
    EXPECT_TRUE(mapped(region, {0, 0, 1.3, 0, 0, 2.2}).empty()) << "no inverse";
    // Onto the slanted line x = 3 y: what rounding leaves between its two sides is no pixel.
    EXPECT_TRUE(mapped(region, {2.25, .75, 3, .75, .25, 1}).empty()) << "no inverse";
  }
  const AffineMap turn = rotation_about({5, 6}, .4), move{.x0 = 2, .y0 = 3};
  const PixelPoint p{7, -1};
  EXPECT_NEAR(distance((turn * move) * p, turn * (move * p)), 0, 1e-12);
  EXPECT_NEAR(distance(turn * PixelPoint{5, 6}, PixelPoint{5, 6}), 0, 1e-12);
  EXPECT_DEATH(mapped(rectangle(3, 3), {.x0 = 40000}), "16 bit");
  EXPECT_DEATH(mapped(rectangle(3, 3), {.x0 = std::numeric_limits<double>::quiet_NaN()}), "finite");
}

}  // namespace
}  // namespace tassilo
