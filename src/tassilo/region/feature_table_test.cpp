#include "tassilo/region/feature_table.h"

#include <gtest/gtest.h>

#include <cmath>
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
    EXPECT_EQ(value("num_sides"), roundness(region).sides);
    EXPECT_EQ(value("contlength"), contour_length(region));
    EXPECT_EQ(value("euler_number"), value("connect_num") - value("holes_num"));
    EXPECT_EQ(value("area_holes"), static_cast<double>(area(fill_holes(region)) - area(region)));
    EXPECT_EQ(value("max_diameter"), diameter(region).length);
    EXPECT_EQ(value("outer_radius"), smallest_circle(region).radius);
    EXPECT_EQ(value("inner_radius"), inner_circle(region).radius);
    EXPECT_EQ(value("inner_width") * value("inner_height"), static_cast<double>(inner_rectangle(region).area()));
    EXPECT_EQ(value("rect2_len1"), smallest_rectangle(region).half_length);
    EXPECT_EQ(value("moments_m11"), shape.moments.rc * static_cast<double>(shape.area));
    const std::vector<Feature> all = every_feature();
    const auto values = feature_values(region, all);
    for (std::size_t k = 0; k < all.size(); ++k)
      EXPECT_EQ(values[k], feature_value(region, all[k])) << to_string(all[k]);
  }
  for (const double nothing : feature_values(Region{}, every_feature())) EXPECT_EQ(nothing, 0);
  // "-0" would be written where 0 is meant.
  for (const double value : feature_values(rectangle(9, 3), every_feature()))
    EXPECT_FALSE(value == 0 && std::signbit(value));
}

}  // namespace
}  // namespace tassilo
