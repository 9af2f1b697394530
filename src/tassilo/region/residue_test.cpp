#include "tassilo/region/residue.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tassilo/region/algebra.h"
#include "tassilo/region/elements.h"
#include "tassilo/region/fill.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

/// Is a neighbor of the pixel in the region (or, without `inside`, outside it)?
bool has_neighbor(const Region& region, PixelShift pixel, Connectivity neighbors, bool inside) {
  for (int dr = -1; dr <= 1; ++dr)
    for (int dc = -1; dc <= 1; ++dc) {
      const int steps = std::abs(dr) + std::abs(dc);
      if (steps == 0 || (neighbors == Connectivity::four && steps == 2)) continue;
      if (contains(region, pixel.columns + dc, pixel.rows + dr) == inside) return true;
    }
  return false;
}

TEST(Boundary, HasANeighborOnTheOtherSide) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const Region& of = region;
    const PixelBox window{box.x0 - 2, box.y0 - 2, box.x1 + 2, box.y1 + 2};
    for (const Connectivity neighbors : {Connectivity::four, Connectivity::eight}) {
      EXPECT_EQ(inner_boundary(region, neighbors), region_by_pixel(window, [&](int c, int r) {
                  return contains(of, c, r) && has_neighbor(of, {c, r}, neighbors, false);
                }));
      EXPECT_EQ(outer_boundary(region, neighbors), region_by_pixel(window, [&](int c, int r) {
                  return !contains(of, c, r) && has_neighbor(of, {c, r}, neighbors, true);
                }));
      EXPECT_EQ(clipped(outer_boundary(region, neighbors), box),
                clipped(inner_boundary(complement(region, window), neighbors), box));
    }
    // A connected boundary encloses what it is the boundary of.
    EXPECT_EQ(fill_holes(inner_boundary(fill_holes(region))), fill_holes(region));
  }
  EXPECT_TRUE(inner_boundary(Region{}).empty());
  EXPECT_TRUE(outer_boundary(Region{}).empty());
}

TEST(Hats, AreWhatOpeningAndClosingChange) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    for (const Region& element : {rectangle(3, 2), disc(1.5), line_element({5, .6})}) {
      EXPECT_EQ(union_of(top_hat(region, element), opening(region, element)), region);
      EXPECT_TRUE(intersection(top_hat(region, element), opening(region, element)).empty());
      EXPECT_EQ(union_of(bottom_hat(region, element), region), closing(region, element));
      EXPECT_TRUE(intersection(bottom_hat(region, element), region).empty());
    }
  }
}

}  // namespace
}  // namespace tassilo
