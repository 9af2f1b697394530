#include "tassilo/region/select.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/features.h"
#include "tassilo/region/fill.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

std::vector<Feature> every_feature() {
  std::vector<Feature> features;
  for (const FeatureInfo& info : all_features()) features.push_back(info.feature);
  return features;
}

TEST(Select, KeepsWhatFitsAllRanges) {
  const Region scene = random_region(5, {{0, 0, 70, 50}, .35, 0});
  const auto parts = components(scene);
  const auto both = select(parts, {{Feature::area, 3, 20}, {Feature::convexity, .8, 1}});
  EXPECT_FALSE(both.empty());
  EXPECT_LT(both.size(), parts.size());
  const auto first = select(parts, {{Feature::area, 3, 20}});
  EXPECT_TRUE(std::ranges::equal(select(first, {{Feature::convexity, .8, 1}}), both));
  std::vector<Region> expected;
  for (const Region& part : parts)
    if (area(part) >= 3 && area(part) <= 20 && convexity(part) >= .8) expected.push_back(part);
  EXPECT_TRUE(std::ranges::equal(both, expected));
  EXPECT_TRUE(std::ranges::equal(select(parts, {}), parts));
  EXPECT_TRUE(select({}, {{Feature::area, 0, 1}}).empty());

  const Region ball = translated(disc(6), {40, 30}), bar = Region::from_box({0, 5, 70, 9});
  const auto round = select(components(union_of(ball, bar)), {{Feature::area, 50, 1e9}, {Feature::circularity, .8, 1}});
  ASSERT_EQ(round.size(), 1u);
  EXPECT_EQ(round.front(), ball);
}

TEST(Sorted, OrdersByAnyFeatureAndKeepsTheOrderOfEquals) {
  const auto parts = components(random_region(8, {{-20, -20, 50, 30}, .3, 0}));
  for (const Feature feature : every_feature())
    for (const SortOrder order : {SortOrder::rising, SortOrder::falling}) {
      SCOPED_TRACE(std::string(to_string(feature)));
      std::vector<Region> expected(parts.begin(), parts.end());
      std::ranges::stable_sort(expected, [&](const Region& a, const Region& b) {
        const double key_a = feature_value(a, feature), key_b = feature_value(b, feature);
        return order == SortOrder::rising ? key_a < key_b : key_b < key_a;
      });
      EXPECT_TRUE(std::ranges::equal(sorted(parts, feature, order), expected));
    }
  EXPECT_TRUE(std::ranges::equal(sorted_by_first_point(sorted(parts, Feature::area)), parts))
      << "components come by first point";
  auto backwards = sorted_by_first_point(parts, SortOrder::falling);
  std::ranges::reverse(backwards);
  EXPECT_TRUE(std::ranges::equal(backwards, parts));
  EXPECT_TRUE(sorted({}, Feature::area).empty());
}

TEST(FillUp, FillsTheHolesThatFit) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    for (const Connectivity foreground : {Connectivity::four, Connectivity::eight}) {
      const FeatureRange range[] = {{Feature::area, 2, 7}};
      EXPECT_EQ(fill_up(region, range, foreground),
                fill_holes(region, {.min_area_px = 2, .max_area_px = 7, .foreground = foreground}));
      EXPECT_EQ(fill_up(region, {}, foreground), fill_holes(region, {.foreground = foreground}));
    }
  }
}

}  // namespace
}  // namespace tassilo
