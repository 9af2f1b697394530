#include "tassilo/detect/line.h"

#include <gtest/gtest.h>

#include "tassilo/detect/test_view.h"

namespace tassilo {
namespace {

using test::Seen;
using test::World;

/// Distance of a point from the straight line through a stripe.
double off_line(FloorPoint p, const test::Stripe& stripe) {
  const FloorPoint along = stripe.b - stripe.a;
  return std::abs(cross(along, p - stripe.a)) / norm(along);
}

TEST(FindLines, FindsStripesAndTheFootOfTheWall) {
  for (const MountedCamera& camera : test::cameras()) {
    SCOPED_TRACE(camera.model().width);
    World world;
    world.wall_x = 3.5;
    world.lines = {{{1.5, -2}, {1.5, 2}}, {{1.0, 0.3}, {3.0, 0.6}}};
    const Seen seen(camera, world);
    const Lines found = find_lines(seen.view());
    int first = 0, second = 0, wall = 0;
    for (const LineSeen& line : found.lines) {
      const auto [p, q] = line.floor.value();
      if (line.kind == LineKind::boundary) {
        EXPECT_LT(std::abs(p.x - 3.5) + std::abs(q.x - 3.5), 0.16);
        ++wall;
      } else if (std::max(off_line(p, world.lines[0]), off_line(q, world.lines[0])) < 0.05) {
        ++first;
      } else {
        EXPECT_LT(std::max(off_line(p, world.lines[1]), off_line(q, world.lines[1])), 0.05);
        ++second;
      }
    }
    EXPECT_GE(first, 1);
    EXPECT_GE(second, 1);
    EXPECT_EQ(wall, 1);
    EXPECT_TRUE(found.circles.empty());
  }
}

TEST(FindLines, FindsTheCircleByItsRadius) {
  const FloorPoint center{2.0, 0.2};
  World world;
  for (int i = 0; i < 72; ++i) {
    const auto at = [&](int k) { return center + FloorPoint{std::cos(k * M_PI / 36), std::sin(k * M_PI / 36)}; };
    world.lines.push_back({at(i), at(i + 1)});
  }
  Seen seen(test::cameras()[1], world);
  seen.field.circle_radius = 1.0;
  const Lines found = find_lines(seen.view());
  ASSERT_EQ(found.circles.size(), 1u);
  EXPECT_LT(distance(found.circles[0].center, center), 0.03);
}

// The plane with most points may be a row of dashes, of which none is a line; there are others.
TEST(FindLines, ARowOfDashesDoesNotEndTheSearch) {
  World world;
  world.wall_x = 1000;
  world.wall_height = 0;
  for (double x = 1.1; x < 5; x += 0.7) world.lines.push_back({{x, 0}, {x + 0.2, 0}});
  const test::Stripe line{{2.2, 0.5}, {2.2, 0.75}};
  world.lines.push_back(line);
  const Seen seen(test::cameras()[1], world);
  const Lines found = find_lines(seen.view(), {.min_points = 24, .min_length = 0.2});
  ASSERT_EQ(found.lines.size(), 1u);
  EXPECT_LT(off_line(found.lines[0].floor->first, line), 0.03);
}

TEST(FindLines, CarpetAloneHasNone) {
  World world;
  world.wall_x = 1000;
  world.wall_height = 0;
  const Seen seen(test::cameras()[0], world);
  EXPECT_TRUE(find_lines(seen.view()).lines.empty());
}

}  // namespace
}  // namespace tassilo
