#include "tassilo/region/select.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/enclosing.h"
#include "tassilo/region/features.h"
#include "tassilo/region/feret.h"
#include "tassilo/region/fill.h"
#include "tassilo/region/inscribed.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

std::vector<Feature> every_feature() {
  std::vector<Feature> features;
  for (const FeatureInfo& info : all_features()) features.push_back(info.feature);
  return features;
}

TEST(FeatureTable, NamesAreUniqueAndComeBack) {
  std::set<std::string_view> names;
  for (const FeatureInfo& info : all_features()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_EQ(feature_named(info.name), info.feature);
    EXPECT_EQ(to_string(info.feature), info.name);
    EXPECT_FALSE(info.meaning.empty());
  }
  EXPECT_EQ(feature_named("aera"), std::nullopt);
  EXPECT_DEATH(to_string(static_cast<Feature>(250)), "known feature");
}

TEST(FeatureTable, GivesWhatTheFunctionsGive) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    const ShapeFeatures shape = shape_features(region);
    const auto value = [&](std::string_view name) { return feature_value(region, feature_named(name).value()); };
    EXPECT_EQ(value("area"), static_cast<double>(shape.area));
    EXPECT_EQ(value("row"), shape.center.y);
    EXPECT_EQ(value("column"), shape.center.x);
    EXPECT_EQ(value("width"), shape.box.width());
    EXPECT_EQ(value("row2") - value("row1") + !region.empty(), shape.box.height());
    EXPECT_EQ(value("column2") - value("column1") + !region.empty(), shape.box.width());
    EXPECT_EQ(value("anisometry"), shape.anisometry);
    EXPECT_EQ(value("struct_factor"), shape.structure_factor);
    EXPECT_EQ(value("orientation"), orientation(region));
    EXPECT_EQ(value("contlength"), contour_length(region));
    EXPECT_EQ(value("euler_number"), value("connect_num") - value("holes_num"));
    EXPECT_EQ(value("area_holes"), static_cast<double>(area(fill_holes(region)) - area(region)));
    EXPECT_EQ(value("max_diameter"), diameter(region).length);
    EXPECT_EQ(value("outer_radius"), smallest_circle(region).radius);
    EXPECT_EQ(value("inner_radius"), inner_circle(region).radius);
    EXPECT_EQ(value("rect2_len1"), smallest_rectangle(region).half_length);
    EXPECT_EQ(value("moments_m11"), shape.moments.rc * static_cast<double>(shape.area));
    const std::vector<Feature> all = every_feature();
    const auto values = feature_values(region, all);
    for (std::size_t k = 0; k < all.size(); ++k)
      EXPECT_EQ(values[k], feature_value(region, all[k])) << to_string(all[k]);
  }
  for (const double nothing : feature_values(Region{}, every_feature())) EXPECT_EQ(nothing, 0);
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
