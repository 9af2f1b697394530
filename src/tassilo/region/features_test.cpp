#include "tassilo/region/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/fill.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<PixelPoint> pixels(const Region& region) {
  std::vector<PixelPoint> points;
  for (const PixelRun& run : region.runs())
    for (int c = run.begin; c < run.end; ++c) points.push_back({double(c), double(run.row)});
  return points;
}

/// A bar through `center` in direction phi as EquivalentEllipse means it. [px], [rad]
Region bar(PixelPoint center, double phi, double half_length) {
  return region_by_pixel({-60, -60, 160, 160}, [&](int c, int r) {
    const PixelPoint from = PixelPoint{double(c), double(r)} - center;
    const PixelPoint axis{std::cos(phi), -std::sin(phi)};
    return std::abs(dot(axis, from)) <= half_length && std::abs(cross(axis, from)) <= half_length / 5;
  });
}

/// Walks once around the outside of an 8-connected region, pixel by pixel (Moore's neighbor tracing).
double traced_length(const Region& component) {
  if (area(component) == 1) return 0;
  constexpr std::array<std::pair<int, int>, 8> kClockwise{
      {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
  const PixelRun first = component.runs().front();
  const auto next_direction = [&](int c, int r, int from) {
    while (!contains(component, c + kClockwise[std::size_t(from)].first, r + kClockwise[std::size_t(from)].second))
      from = (from + 1) % 8;
    return from;
  };
  // Above and left of the first pixel is nothing, so the search may begin towards the right.
  const int start = next_direction(first.begin, first.row, 0);
  int c = first.begin, r = first.row, direction = start;
  double length = 0;
  do {
    c += kClockwise[std::size_t(direction)].first;
    r += kClockwise[std::size_t(direction)].second;
    length += direction % 2 == 1 ? std::numbers::sqrt2 : 1;
    // The last background pixel looked at lies two steps back for a straight move, three for a diagonal one.
    direction = next_direction(c, r, (direction + (direction % 2 == 1 ? 6 : 7)) % 8);
  } while (c != first.begin || r != first.row || direction != start);
  return length;
}

TEST(Features, MomentsEqualSumsOverPixels) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    const ShapeFeatures features = shape_features(region);
    const std::vector<PixelPoint> points = pixels(region);
    ASSERT_EQ(features.area, std::ssize(points));
    EXPECT_EQ(features.box, bounding_box(region));
    if (points.empty()) continue;
    const double n = static_cast<double>(points.size());
    PixelPoint center;
    for (const PixelPoint& p : points) center = center + (1 / n) * p;
    double rr = 0, rc = 0, cc = 0, largest = 0;
    for (const PixelPoint& p : points) {
      const PixelPoint d = p - center;
      rr += d.y * d.y / n;
      rc += d.x * d.y / n;
      cc += d.x * d.x / n;
      largest = std::max(largest, dot(d, d));
    }
    EXPECT_NEAR(features.center.x, center.x, 1e-9);
    EXPECT_NEAR(features.center.y, center.y, 1e-9);
    EXPECT_NEAR(features.moments.rr, rr, 1e-9);
    EXPECT_NEAR(features.moments.rc, rc, 1e-9);
    EXPECT_NEAR(features.moments.cc, cc, 1e-9);
    EXPECT_NEAR(features.circularity, largest > 0 ? std::min(1., n / (kPi * largest)) : 1, 1e-9);
    // HALCON's text: Ra, Rb = sqrt(8 (M20 + M02 +- sqrt((M20 - M02)^2 + 4 M11^2))) / 2.
    const double root = std::sqrt((rr - cc) * (rr - cc) + 4 * rc * rc);
    EXPECT_NEAR(features.ellipse.ra, std::sqrt(8 * (rr + cc + root)) / 2, 1e-6);
    EXPECT_NEAR(features.ellipse.rb, std::sqrt(8 * std::max(0., rr + cc - root)) / 2, 1e-6);
    EXPECT_NEAR(features.bulkiness, kPi * features.ellipse.ra * features.ellipse.rb / n, 1e-9);
  }
}

TEST(Features, MoveWithTheRegionAndTurnWithIt) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    if (region.empty()) continue;
    const ShapeFeatures here = shape_features(region), there = shape_features(translated(region, {12000, -9000}));
    EXPECT_NEAR(there.center.x - here.center.x, 12000, 1e-8);
    EXPECT_NEAR(there.center.y - here.center.y, -9000, 1e-8);
    EXPECT_DOUBLE_EQ(there.moments.rc, here.moments.rc);
    EXPECT_NEAR(there.circularity, here.circularity, 1e-9);
    const ShapeFeatures turned = shape_features(transposed(region));
    EXPECT_NEAR(turned.ellipse.ra, here.ellipse.ra, 1e-7);
    EXPECT_NEAR(turned.moments.rr, here.moments.cc, 1e-9);
    EXPECT_NEAR(turned.anisometry, here.anisometry, 1e-6 * (1 + here.anisometry * here.anisometry));
  }
}

TEST(Features, OrientationIsCounterClockwiseOnTheScreen) {
  for (const double phi_deg : {-80., -60., -45., -10., 0., 20., 45., 70., 89.}) {
    SCOPED_TRACE(phi_deg);
    const double phi = phi_deg * kPi / 180;
    EXPECT_NEAR(shape_features(bar({40, 50}, phi, 40)).ellipse.phi, phi, .01);
  }
  EXPECT_DOUBLE_EQ(shape_features(rectangle(1, 9)).ellipse.phi, kPi / 2);
  EXPECT_DOUBLE_EQ(shape_features(rectangle(9, 1)).ellipse.phi, 0);
  EXPECT_DOUBLE_EQ(shape_features(rectangle(5, 5)).ellipse.phi, 0);
}

TEST(Features, OrientationPointsToTheFarEnd) {
  for (int turn_deg = -175; turn_deg <= 180; turn_deg += 5) {
    SCOPED_TRACE(turn_deg);
    const double phi = turn_deg * kPi / 180;
    const PixelPoint axis{std::cos(phi), -std::sin(phi)};
    // A drop: its tip is farthest from the centre.
    const Region drop = region_by_pixel({-80, -80, 81, 81}, [&](int c, int r) {
      const PixelPoint p{double(c), double(r)};
      const double along = dot(axis, p);
      return along > -20 && along < 60 && std::abs(cross(axis, p)) < (60 - along) / 5;
    });
    EXPECT_NEAR(std::remainder(orientation(drop) - phi, 2 * kPi), 0, .02);
    EXPECT_GT(orientation(drop), -kPi);
    EXPECT_LE(orientation(drop), kPi);
  }
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    const Region region = random_case(seed).region;
    const double phi = shape_features(region).ellipse.phi, there = orientation(region);
    EXPECT_NEAR(std::remainder(there - phi, kPi), 0, 1e-12) << "seed " << seed;
    EXPECT_DOUBLE_EQ(orientation(union_of(region, reflected(region))),
                     shape_features(union_of(region, reflected(region))).ellipse.phi);
  }
  EXPECT_EQ(orientation(Region{}), 0);
}

TEST(Features, OfADiscAreThoseOfACircle) {
  const ShapeFeatures features = shape_features(translated(disc(50), {100, 80}));
  EXPECT_NEAR(features.center.x, 100, 1e-12);
  EXPECT_NEAR(features.center.y, 80, 1e-12);
  EXPECT_NEAR(features.ellipse.ra, 50, .2);
  EXPECT_NEAR(features.ellipse.rb, 50, .2);
  EXPECT_NEAR(features.anisometry, 1, 1e-6);
  EXPECT_NEAR(features.bulkiness, 1, .01);
  EXPECT_NEAR(features.structure_factor, 0, .01);
  EXPECT_NEAR(features.circularity, 1, .01);
  EXPECT_NEAR(compactness(disc(50)), 1.05, .07);
  EXPECT_DOUBLE_EQ(convexity(disc(50)), 1);
}

TEST(Features, OfLinesAndSinglePixelsAreHalconsZeros) {
  RunVector slanted;
  for (std::int16_t k = 0; k < 200; ++k) {
    const auto column = static_cast<std::int16_t>(3 * k);
    slanted.push_back({k, column, static_cast<std::int16_t>(column + 1)});
  }
  for (const Region& line : {rectangle(9, 1), rectangle(1, 9), rectangle(1, 1), Region::from_runs(slanted)}) {
    const ShapeFeatures features = shape_features(line);
    EXPECT_EQ(features.ellipse.rb, 0);
    EXPECT_EQ(features.anisometry, 0);
    EXPECT_EQ(features.bulkiness, 0);
    EXPECT_EQ(features.structure_factor, 0);
    EXPECT_EQ(convexity(line), 1);
  }
  // Lines of every slope and length: rounding must not give them a width.
  for (int step = 1; step < 40; ++step)
    for (int count = 2; count < 120; count += 7) {
      RunVector line;
      for (int k = 0; k < count; ++k)
        line.push_back({static_cast<std::int16_t>(k), static_cast<std::int16_t>(step * k),
                        static_cast<std::int16_t>(step * k + 1)});
      EXPECT_EQ(shape_features(Region::from_runs(line)).ellipse.rb, 0) << "step " << step << ", count " << count;
    }
  EXPECT_EQ(shape_features(rectangle(1, 1)).circularity, 1);
  // One pixel of 201 beside the line, at distance 1 / sqrt 10.
  const Region bent = union_of(Region::from_runs(slanted), Region::from_runs({{100, 301, 302}}));
  EXPECT_NEAR(shape_features(bent).ellipse.rb, 2 * std::sqrt(.1 / 201), 1e-3);
}

/// The snippet of docs/regions.md, word by word.
std::vector<PixelPoint> round_things(const Region& red) {
  std::vector<PixelPoint> centers;
  for (const Region& part : components(opening(red, rectangle(3, 3)))) {
    const ShapeFeatures shape = shape_features(part);
    if (shape.area > 50 && shape.anisometry < 1.5) centers.push_back(shape.center);
  }
  return centers;
}

TEST(Features, FindTheBallAsTheManualSays) {
  const Region ball = translated(disc(6), {40, 30}), bar = Region::from_box({0, 5, 70, 9});
  const Region specks = random_region(3, {{0, 0, 80, 50}, .02, 0});
  const std::vector<PixelPoint> found = round_things(union_of(std::vector{ball, bar, specks}));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].x, 40, .3);
  EXPECT_NEAR(found[0].y, 30, .3);
}

TEST(Features, OfNothingAreZero) {
  const ShapeFeatures features = shape_features({});
  EXPECT_EQ(features.area, 0);
  EXPECT_EQ(features.circularity, 0);
  EXPECT_TRUE(features.box.empty());
  EXPECT_EQ(contour_length({}), 0);
  EXPECT_EQ(compactness({}), 0);
  EXPECT_EQ(euler_number({}), 0);
  EXPECT_EQ(hole_count({}), 0);
  EXPECT_TRUE(convex_hull({}).empty());
  EXPECT_EQ(convex_area({}), 0);
  EXPECT_EQ(convexity({}), 0);
  EXPECT_EQ(rectangularity({}), 0);
}

TEST(ContourLength, EqualsTracingEachComponent) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    double traced = 0;
    for (const Region& part : components(region)) traced += traced_length(part);
    EXPECT_NEAR(contour_length(region), traced, 1e-9);
  }
}

TEST(ContourLength, OfKnownShapes) {
  EXPECT_DOUBLE_EQ(contour_length(rectangle(1, 1)), 0);
  EXPECT_DOUBLE_EQ(contour_length(rectangle(7, 1)), 12);
  EXPECT_DOUBLE_EQ(contour_length(rectangle(7, 4)), 18);
  EXPECT_DOUBLE_EQ(contour_length(disc(1)), 4 * std::numbers::sqrt2);
  EXPECT_DOUBLE_EQ(compactness(rectangle(7, 4)), std::max(1., 18. * 18. / (4 * kPi * 28)));
  const Region ring = difference(rectangle(11, 11), rectangle(5, 5));
  EXPECT_DOUBLE_EQ(contour_length(ring), 40) << "the hole's contour does not count";
  EXPECT_DOUBLE_EQ(contour_length(union_of(ring, rectangle(2, 2))), 44) << "the island's does";
}

TEST(Holes, CountedByTheEulerNumber) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    for (const Connectivity foreground : {Connectivity::four, Connectivity::eight}) {
      const auto parts = std::ssize(components(region, foreground));
      const auto inside = std::ssize(components(holes(region, foreground), dual(foreground)));
      EXPECT_EQ(euler_number(region, foreground), parts - inside);
      EXPECT_EQ(hole_count(region, foreground), inside);
    }
  }
}

TEST(ConvexHull, HoldsAllPixelsTurnsClockwiseAndHasItsCornersInTheRegion) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    if (region.empty()) continue;
    const RecycledVector<PixelPoint> hull = convex_hull(region);
    const PixelRun first = region.runs().front();
    EXPECT_EQ(hull.front(), (PixelPoint{double(first.begin), double(first.row)}));
    const auto side = [&](std::size_t i, PixelPoint p) {
      return cross(hull[(i + 1) % hull.size()] - hull[i], p - hull[i]);
    };
    for (std::size_t i = 0; i < hull.size(); ++i) {
      EXPECT_TRUE(contains(region, int(hull[i].x), int(hull[i].y)));
      if (hull.size() > 2) {
        EXPECT_GT(side(i, hull[(i + 2) % hull.size()]), 0);
      }
      for (const PixelPoint& p : pixels(region)) ASSERT_GE(side(i, p), 0);
    }
    const Region filled = region_by_pixel(box, [&](int c, int r) {
      const PixelPoint p{double(c), double(r)};
      for (std::size_t i = 0; i < hull.size(); ++i)
        if (side(i, p) < 0) return false;
      // A hull without area holds what lies between its ends only.
      return hull.size() > 2 || dot(hull.front() - p, hull.back() - p) <= 0;
    });
    EXPECT_EQ(convex_area(region), area(filled));
    EXPECT_DOUBLE_EQ(convexity(region), static_cast<double>(area(region)) / static_cast<double>(area(filled)));
    EXPECT_DOUBLE_EQ(convexity(filled), 1);
  }
}

TEST(Rectangularity, IsOneForRectanglesAndLessForOthers) {
  for (int width = 1; width < 12; ++width)
    for (int height = 1; height < 12; ++height)
      EXPECT_DOUBLE_EQ(rectangularity(translated(rectangle(width, height), {-7, 40})), 1) << width << "x" << height;
  EXPECT_GT(rectangularity(bar({40, 50}, .4, 60)), .93);
  EXPECT_LT(rectangularity(disc(30)), .9);
  EXPECT_LT(rectangularity(difference(rectangle(31, 31), rectangle(25, 25))), .6);
}

}  // namespace
}  // namespace tassilo
