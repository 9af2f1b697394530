#include "tassilo/region/relation.h"

#include <gtest/gtest.h>

#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/test_regions.h"

namespace tassilo {
namespace {

TEST(Relation, EqualsWhatTheOperatorsGive) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [a, box] = random_case(seed);
    const Region b = translated(random_region(seed + 1, {box, .4, seed % 4 == 0 ? 2 : 0}), {1, -1});
    const Region both = intersection(a, b), any = union_of(a, b);
    EXPECT_EQ(common_area(a, b), area(both));
    EXPECT_EQ(overlaps(a, b), !both.empty());
    EXPECT_EQ(is_subset(a, b), difference(a, b).empty());
    EXPECT_TRUE(is_subset(both, a));
    EXPECT_TRUE(is_subset(b, any));
    EXPECT_EQ(is_subset(any, b), is_subset(a, b));
    EXPECT_EQ(hamming_distance(a, b), area(symmetric_difference(a, b)));
    EXPECT_EQ(intersection_over_union(a, b),
              any.empty() ? 0 : static_cast<double>(area(both)) / static_cast<double>(area(any)));
  }
  EXPECT_TRUE(is_subset(Region{}, Region{}));
  EXPECT_FALSE(overlaps(Region{}, Region{}));
}

}  // namespace
}  // namespace tassilo
