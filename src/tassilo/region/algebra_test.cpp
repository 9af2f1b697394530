#include "tassilo/region/algebra.h"

#include <gtest/gtest.h>

#include <vector>

#include "tassilo/region/internal/test_regions.h"

namespace tassilo {
namespace {

struct Pair {
  Region a, b;
  PixelBox box;
};

Pair random_pair(unsigned seed) {
  const RandomCase first = random_case(seed);
  const Region second = random_region(seed + 1000, {first.box, .4, seed % 7 == 3 ? 3 : 0});
  // Moved a little, so that some rows and columns hold one of the two only.
  return {first.region, translated(second, {1, -2}), hull(first.box, bounding_box(translated(second, {1, -2})))};
}

TEST(Algebra, EqualsPixelByPixel) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [a, b, box] = random_pair(seed);
    const auto by_pixel = [&, &first = a, &second = b](auto op) {
      return region_by_pixel(box, [&](int c, int r) { return op(contains(first, c, r), contains(second, c, r)); });
    };
    EXPECT_EQ(union_of(a, b), by_pixel([](bool p, bool q) { return p || q; }));
    EXPECT_EQ(intersection(a, b), by_pixel([](bool p, bool q) { return p && q; }));
    EXPECT_EQ(difference(a, b), by_pixel([](bool p, bool q) { return p && !q; }));
    EXPECT_EQ(symmetric_difference(a, b), by_pixel([](bool p, bool q) { return p != q; }));
    EXPECT_EQ(complement(a, box), by_pixel([](bool p, bool) { return !p; }));
  }
}

TEST(Algebra, KeepsTheLawsOfSets) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [a, b, box] = random_pair(seed);
    EXPECT_EQ(complement(union_of(a, b), box), intersection(complement(a, box), complement(b, box)));
    EXPECT_EQ(union_of(difference(a, b), intersection(a, b)), a);
    EXPECT_EQ(symmetric_difference(symmetric_difference(a, b), b), a);
    EXPECT_EQ(complement(complement(a, box), box), a);
    EXPECT_EQ(area(union_of(a, b)) + area(intersection(a, b)), area(a) + area(b));
    EXPECT_EQ(union_of(a, Region{}), a);
    EXPECT_TRUE(intersection(a, Region{}).empty());
    EXPECT_TRUE(difference(a, a).empty());
  }
}

TEST(Algebra, UnionOfManyIsUnionOneByOne) {
  std::vector<Region> regions;
  Region sum;
  for (unsigned seed = 0; seed < 9; ++seed) {
    EXPECT_EQ(union_of(regions), sum);
    regions.push_back(random_case(seed).region);
    sum = union_of(sum, regions.back());
  }
}

TEST(Algebra, MovesAndMirrors) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const Region moved = translated(region, {-7, 3});
    EXPECT_EQ(area(moved), area(region));
    EXPECT_EQ(translated(moved, {7, -3}), region);
    const Region turned = transposed(region), mirrored = reflected(region);
    EXPECT_EQ(turned, region_by_pixel({box.y0, box.x0, box.y1, box.x1},
                                      [&, &of = region](int c, int r) { return contains(of, r, c); }));
    EXPECT_EQ(transposed(turned), region);
    EXPECT_EQ(mirrored, region_by_pixel({1 - box.x1, 1 - box.y1, 1 - box.x0, 1 - box.y0},
                                        [&, &of = region](int c, int r) { return contains(of, -c, -r); }));
    EXPECT_EQ(reflected(mirrored), region);
    for (int c = box.x0; c < box.x1; ++c)
      for (int r = box.y0; r < box.y1; ++r) ASSERT_EQ(contains(moved, c - 7, r + 3), contains(region, c, r));
  }
}

TEST(Algebra, ClipsLikeIntersectionWithTheBox) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const PixelBox inner{box.x0 + box.width() / 3, box.y0 + 1, box.x1 - box.width() / 4, box.y1 - 2};
    EXPECT_EQ(clipped(region, inner), intersection(region, Region::from_box(inner)));
    EXPECT_EQ(clipped(region, {-100000, -100000, 100000, 100000}), region);
    EXPECT_TRUE(clipped(region, {}).empty());
  }
}

TEST(Algebra, ReachesTheLimitsOf16BitsAndBreaksThePromiseBeyond) {
  const Region edge = Region::from_runs({{32767, 32760, 32767}, {-32768, -32768, -32760}});
  EXPECT_EQ(transposed(Region::from_runs({{-32768, 5, 7}, {32766, 5, 6}})),
            Region::from_runs({{5, -32768, -32767}, {6, -32768, -32767}, {5, 32766, 32767}}));
  EXPECT_DEATH(translated(edge, {0, 1}), "16 bit");
  EXPECT_DEATH(translated(edge, {-1, 0}), "16 bit");
  EXPECT_DEATH(reflected(edge), "16 bit");
  EXPECT_DEATH(Region::from_box({0, 0, 40000, 2}), "16 bit");
}

}  // namespace
}  // namespace tassilo
