#include "tassilo/region/raster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/test_regions.h"

namespace tassilo {
namespace {

ByteView view_of(const std::vector<std::uint8_t>& bytes, const PixelBox& box) {
  return {bytes.data(), box.width(), box.height(), box.width()};
}

TEST(Mask, RoundTripOfEveryWidth) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const std::vector<std::uint8_t> mask = to_mask(region, box, 7);
    ASSERT_EQ(std::ssize(mask), box.area());
    for (int r = box.y0, i = 0; r < box.y1; ++r)
      for (int c = box.x0; c < box.x1; ++c, ++i) ASSERT_EQ(mask[std::size_t(i)], contains(region, c, r) ? 7 : 0);
    const Region back = region_where(view_of(mask, box), [](int byte) { return byte == 7; });
    EXPECT_EQ(translated(back, {box.x0, box.y0}), region);
  }
}

TEST(Mask, CutsAtTheWindowAndSkipsPadding) {
  const Region region = Region::from_box({-5, -5, 3, 2});
  EXPECT_EQ(to_mask(region, {0, 0, 4, 3}, 1), (std::vector<std::uint8_t>{1, 1, 1, 0, 1, 1, 1, 0, 0, 0, 0, 0}));
  const std::vector<std::uint8_t> padded{1, 0, 1, 9, 9, 0, 2, 2, 9, 9};
  const ByteView view{padded.data(), 3, 2, 5};
  EXPECT_EQ(region_where(view, [](int byte) { return byte != 0; }),
            Region::from_runs({{0, 0, 1}, {0, 2, 3}, {1, 1, 3}}));
  EXPECT_TRUE(region_where(view, [](int byte) { return byte == 9; }).empty());
  EXPECT_TRUE(region_where(ByteView{}, [](int) { return true; }).empty());
}

TEST(Labels, RoundTrip) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const PixelBox box{0, 0, 1 + static_cast<int>(seed * 5 % 67), 5};
    std::vector<std::uint8_t> labels(static_cast<std::size_t>(box.area()));
    for (std::uint8_t& label : labels) label = static_cast<std::uint8_t>(random() % 9);
    const std::vector<Region> regions = regions_of_labels(view_of(labels, box), 9);
    ASSERT_EQ(regions.size(), 9u);
    EXPECT_EQ(to_labels(regions, box), labels);
    EXPECT_EQ(union_of(regions), Region::from_box(box));
    for (int k = 0; k < 9; ++k)
      EXPECT_EQ(regions[std::size_t(k)], region_where(view_of(labels, box), [&](int byte) { return byte == k; }));
    EXPECT_EQ(regions_of_labels(view_of(labels, box), 2).back(), regions[1]);
  }
}

TEST(Polygon, OfABoxIsHalfOpen) {
  const std::vector<PixelPoint> box{{2, 1}, {6, 1}, {6, 4}, {2, 4}};
  EXPECT_EQ(region_from_polygon(box, {0, 0, 20, 20}), Region::from_box({2, 1, 6, 4}));
  const std::vector<PixelPoint> backwards(box.rbegin(), box.rend());
  EXPECT_EQ(region_from_polygon(backwards, {0, 0, 20, 20}), Region::from_box({2, 1, 6, 4}));
  const std::vector<PixelPoint> around{{1.5, .5}, {5.5, .5}, {5.5, 3.5}, {1.5, 3.5}};
  EXPECT_EQ(region_from_polygon(around, {0, 0, 20, 20}), Region::from_box({2, 1, 6, 4}));
}

TEST(Polygon, HoldsTheCentresInsideByCrossingCount) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> somewhere(-8, 30);
    std::vector<PixelPoint> polygon(3 + seed % 8);
    for (PixelPoint& p : polygon) p = {somewhere(random), somewhere(random)};
    const PixelBox window{-3, -2, 20, 25};
    const Region expected = region_by_pixel(window, [&](int c, int r) {
      bool inside = false;  // crossings of the ray to the left, by which side of each edge the point lies on
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const PixelPoint p = polygon[i], q = polygon[(i + 1) % polygon.size()], at{double(c), double(r)};
        if ((p.y <= r) == (q.y <= r)) continue;
        inside ^= (cross(q - p, at - p) > 0) == (q.y < p.y);
      }
      return inside;
    });
    EXPECT_EQ(region_from_polygon(polygon, window), expected);
  }
}

TEST(Polygon, NeighborsShareNoPixelAndLeaveNoGap) {
  // A fan of triangles around an inner point, corners on and off pixel centres, tiles the whole polygon.
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const int corners = 3 + static_cast<int>(seed % 9);
    std::vector<PixelPoint> outline;
    for (int k = 0; k < corners; ++k) {
      const double angle = 2 * std::numbers::pi * k / corners, radius = 8 + static_cast<double>(random() % 12);
      PixelPoint p{30 + radius * std::cos(angle), 30 + radius * std::sin(angle)};
      if (seed % 2 == 0) p = {std::round(p.x), std::round(p.y)};
      outline.push_back(p);
    }
    const PixelBox window{0, 0, 60, 60};
    const PixelPoint middle{30, 30};
    std::int64_t sum = 0;
    std::vector<Region> triangles;
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const PixelPoint p = outline[k], q = outline[(k + 1) % outline.size()];
      triangles.push_back(region_from_polygon(std::vector{middle, p, q}, window));
      sum += area(triangles.back());
    }
    EXPECT_EQ(area(union_of(triangles)), sum);
    EXPECT_EQ(union_of(triangles), region_from_polygon(outline, window));
  }
}

TEST(Polygon, FarOutsideOrWithoutAreaIsHarmless) {
  const PixelBox window{0, 0, 10, 10};
  const std::vector<PixelPoint> huge{{-1e9, -1e9}, {1e9, -1e9}, {1e9, 1e9}, {-1e9, 1e9}};
  EXPECT_EQ(region_from_polygon(huge, window), Region::from_box(window));
  EXPECT_TRUE(region_from_polygon(std::vector<PixelPoint>{{50, 50}, {60, 50}, {60, 60}}, window).empty());
  EXPECT_TRUE(region_from_polygon(std::vector<PixelPoint>{{1, 1}, {8, 8}}, window).empty());
  EXPECT_TRUE(region_from_polygon(std::vector<PixelPoint>{{1, 1}, {8, 8}, {4, 4}}, window).empty());
  EXPECT_TRUE(region_from_polygon(huge, {}).empty());
  EXPECT_DEATH(region_from_polygon(std::vector<PixelPoint>{{1, 1}, {std::nan(""), 8}, {4, 4}}, window), "finite");
}

double distance_to_segment(PixelPoint p, PixelPoint a, PixelPoint b) {
  const PixelPoint along = b - a;
  const double square = dot(along, along);
  const double share = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0;
  return distance(p, a + share * along);
}

// What is within rounding of the brush's rim may be on either side.
TEST(Raster, StrokesHoldWhatIsNearTheirWay) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-8, 40), brush(0, 9);
  const PixelBox window{-2, 1, 31, 27};
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<PixelPoint> way(1 + random() % 4);
    for (PixelPoint& point : way) point = {place(random), place(random)};
    if (trial % 3 == 0)
      for (PixelPoint& point : way) point = {std::round(point.x), std::round(point.y)};
    if (trial % 5 == 0) way.push_back(way.back());
    const double radius = trial % 4 == 0 ? std::round(brush(random)) : brush(random);
    const Region region = region_from_stroke(way, radius, window);
    for (int r = -10; r < 40; ++r)
      for (int c = -10; c < 45; ++c) {
        const PixelPoint pixel{double(c), double(r)};
        double nearest = distance(pixel, way[0]);
        for (std::size_t i = 1; i < way.size(); ++i)
          nearest = std::min(nearest, distance_to_segment(pixel, way[i - 1], way[i]));
        const bool is_in_window = c >= window.x0 && c < window.x1 && r >= window.y0 && r < window.y1;
        if (std::abs(nearest - radius) <= 1e-9) continue;
        EXPECT_EQ(contains(region, c, r), is_in_window && nearest < radius) << trial << ": " << c << ", " << r;
      }
  }
  EXPECT_TRUE(region_from_stroke({}, 3, window).empty());
  EXPECT_EQ(region_from_stroke(std::vector<PixelPoint>{{5, 6}}, 0, window), Region::from_box({5, 6, 6, 7}));
}

}  // namespace
}  // namespace tassilo
