#include "tassilo/region/components.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <set>
#include <utility>
#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/features.h"
#include "tassilo/region/internal/test_regions.h"

namespace tassilo {
namespace {

/// Flood fill from each pixel not yet seen, in the order of rows and columns.
RecycledVector<Region> components_by_pixel(const Region& region, Connectivity connectivity) {
  std::set<std::pair<int, int>> left;
  for (const PixelRun& run : region.runs())
    for (int c = run.begin; c < run.end; ++c) left.insert({run.row, c});
  RecycledVector<Region> result;
  while (!left.empty()) {
    std::vector<std::pair<int, int>> open{*left.begin()};
    left.erase(left.begin());
    RunVector runs;
    while (!open.empty()) {
      const auto [row, column] = open.back();
      open.pop_back();
      runs.push_back(
          {static_cast<std::int16_t>(row), static_cast<std::int16_t>(column), static_cast<std::int16_t>(column + 1)});
      for (int dr = -1; dr <= 1; ++dr)
        for (int dc = -1; dc <= 1; ++dc) {
          if (connectivity == Connectivity::four && std::abs(dr) + std::abs(dc) == 2) continue;
          if (left.erase({row + dr, column + dc}) > 0) open.push_back({row + dr, column + dc});
        }
    }
    result.push_back(Region::from_runs(std::move(runs)));
  }
  return result;
}

TEST(Components, EqualFloodFillInOrder) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    for (const Connectivity connectivity : {Connectivity::four, Connectivity::eight})
      EXPECT_EQ(components(region, connectivity), components_by_pixel(region, connectivity));
  }
}

TEST(Components, KeepEveryPixelOnce) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    for (const Connectivity connectivity : {Connectivity::four, Connectivity::eight}) {
      const RecycledVector<Region> parts = components(region, connectivity);
      std::int64_t sum = 0;
      for (const Region& part : parts) {
        sum += area(part);
        EXPECT_EQ(label_runs(part, connectivity).count, 1);
      }
      EXPECT_EQ(sum, area(region));
      EXPECT_EQ(union_of(parts), region);
    }
  }
}

TEST(ComponentFeatures, AreThoseOfTheComponentsInOrder) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    for (const Connectivity connectivity : {Connectivity::four, Connectivity::eight}) {
      const RecycledVector<Region> parts = components(region, connectivity);
      const RecycledVector<ComponentFeatures> features = component_features(region, connectivity);
      ASSERT_EQ(features.size(), parts.size());
      for (std::size_t i = 0; i < parts.size(); ++i) {
        const ShapeFeatures shape = shape_features(parts[i]);
        EXPECT_EQ(features[i].area, shape.area);
        EXPECT_EQ(features[i].box, shape.box);
        EXPECT_NEAR(distance(features[i].center, shape.center), 0, 1e-9);
      }
    }
  }
}

TEST(Components, NestedSpiralsJoinLate) {
  // A comb whose teeth meet in the last row only, and one that meets in the first row only.
  RunVector teeth;
  for (std::int16_t row = 0; row < 5; ++row)
    for (std::int16_t c = 0; c < 40; c = static_cast<std::int16_t>(c + 2))
      teeth.push_back({row, c, static_cast<std::int16_t>(c + 1)});
  const auto with_bar = [&](std::int16_t row) {
    RunVector runs = teeth;
    runs.push_back({row, 0, 39});
    return Region::from_runs(std::move(runs));
  };
  EXPECT_EQ(label_runs(Region::from_runs(teeth)).count, 20);
  EXPECT_EQ(label_runs(with_bar(5)).count, 1);
  EXPECT_EQ(label_runs(with_bar(-1)).count, 1);
}

TEST(Components, OfNothingAreNone) {
  EXPECT_TRUE(components(Region{}).empty());
  EXPECT_TRUE(component_features(Region{}).empty());
  EXPECT_EQ(label_runs(Region{}).count, 0);
}

}  // namespace
}  // namespace tassilo
