#include "tassilo/detect/robot.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tassilo/base/error.h"
#include "tassilo/detect/test_view.h"

namespace tassilo {
namespace {

using test::Seen;
using test::World;

TEST(FindRobots, TellsTeamNearestPointAndWidth) {
  for (const MountedCamera& camera : test::cameras())
    for (const FloorPoint foot : {FloorPoint{1.4, 0.2}, FloorPoint{2.2, -0.3}, FloorPoint{3.5, 0.4}}) {
      SCOPED_TRACE(testing::Message() << camera.model().width << " px at " << foot.x << ", " << foot.y);
      World world;
      world.robots.push_back({.foot = foot, .radius = 0.2, .marker = test::kMagenta});
      const Seen seen(camera, world);
      const auto robots = find_robots(seen.view());
      ASSERT_EQ(robots.size(), 1u);
      EXPECT_EQ(robots[0].team, Team::magenta);
      const RobotOnFloor& floor = robots[0].floor.value();
      const FloorPoint nearest = (1 - 0.2 / norm(foot)) * foot;
      EXPECT_LT(distance(floor.nearest.mean, nearest), 0.03 + 0.02 * norm(nearest));
      EXPECT_LE(floor.bounds.near, norm(nearest));
      EXPECT_GE(floor.bounds.far, norm(nearest));
      EXPECT_NEAR(floor.width, 0.4, 0.1);
      EXPECT_LT(distance(floor.center, foot), 0.12);
    }
}

TEST(FindRobots, ThoseThatHideEachOtherComeApart) {
  World world;
  world.robots.push_back({.foot = {1.6, 0.15}, .radius = 0.2, .marker = test::kCyan});
  world.robots.push_back({.foot = {2.6, -0.25}, .radius = 0.2, .marker = test::kCyan});    // further, same color
  world.robots.push_back({.foot = {1.6, 0.56}, .radius = 0.2, .marker = test::kMagenta});  // touching, other color
  const Seen seen(test::cameras()[1], world);
  const auto robots = find_robots(seen.view());
  ASSERT_EQ(robots.size(), 3u);
  EXPECT_EQ(robots[0].team, Team::magenta);
  EXPECT_EQ(robots[1].team, Team::cyan);
  EXPECT_EQ(robots[2].team, Team::cyan);
  EXPECT_LT(norm(robots[1].floor->nearest.mean) + 0.5, norm(robots[2].floor->nearest.mean));
}

TEST(FindRobots, WhatStandsBehindTheWallIsNone) {
  World world;
  world.wall_x = 2;
  world.robots.push_back({.foot = {2.6, 0.0}, .radius = 0.25, .height = 1.2, .band = 0.8});
  const Seen seen(test::cameras()[1], world);
  EXPECT_TRUE(find_robots(seen.view()).empty());
}

TEST(FindRobots, WithoutMarkerItIsToldByItsSizeButNotFromBlackBoards) {
  World world;
  world.robots.push_back({.foot = {1.8, 0.1}, .radius = 0.2, .height = 0.5, .band = 1});
  world.robots.push_back({.foot = {2.6, -1.6}, .radius = 0.9, .height = 0.5, .band = 1});  // too wide for a robot
  Seen seen(test::cameras()[1], world);
  const auto robots = find_robots(seen.view());
  ASSERT_EQ(robots.size(), 1u);
  EXPECT_EQ(robots[0].team, Team::unknown);
  EXPECT_LT(distance(robots[0].floor->center, {1.8, 0.1}), 0.12);
  seen.field.walls->color = "black";
  EXPECT_TRUE(find_robots(seen.view()).empty());
}

TEST(FindRobots, NearTheHorizonNothingBoundsThemFromAbove) {
  World world;
  world.wall_x = 12;
  world.robots.push_back({.foot = {7.5, 2.3}, .radius = 0.25, .height = 0.8, .marker = test::kMagenta});
  const Seen seen(test::cameras()[2], world);
  const auto bounds = [&](double sigma) {
    RobotOptions options;
    options.foot_sigma_px = sigma;
    const auto robots = find_robots(seen.view(), options);
    return robots.size() == 1 ? robots[0].floor->bounds : DistanceBounds{-1, -1};
  };
  const DistanceBounds sure = bounds(0.1), unsure = bounds(4);
  EXPECT_GT(sure.near, 6);
  EXPECT_LT(sure.far, 10);
  EXPECT_LT(unsure.near, sure.near);
  EXPECT_EQ(unsure.far, std::numeric_limits<double>::infinity());
}

TEST(FindRobots, ComeFromLeftToRightWithFiniteValuesWithinTheirBounds) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(0.6, 4), bearing_tangent(-0.7, 0.7), radius(0.12, 0.3);
  for (int trial = 0; trial < 12; ++trial) {
    SCOPED_TRACE(trial);
    World world;
    for (int i = 0; i < 5; ++i) {
      const double range = x(random);
      world.robots.push_back({.foot = {range, range * bearing_tangent(random)},
                              .radius = radius(random),
                              .marker = i % 2 == 0 ? test::kCyan : test::kMagenta});
    }
    const Seen seen(test::cameras()[static_cast<std::size_t>(trial % 3)], world);
    const auto robots = find_robots(seen.view());
    EXPECT_FALSE(robots.empty());
    EXPECT_TRUE(std::ranges::is_sorted(robots, {}, [](const RobotSeen& robot) { return robot.box.x0; }));
    for (const RobotSeen& robot : robots) {
      const RobotOnFloor& floor = robot.floor.value();
      const double range = norm(floor.nearest.mean);
      EXPECT_TRUE(std::isfinite(floor.width) && std::isfinite(norm(floor.center)));
      EXPECT_LE(floor.bounds.near, range);
      EXPECT_GE(floor.bounds.far, range);
      EXPECT_GT(norm(floor.center), range);
    }
  }
}

TEST(FindRobots, WithoutCalibrationItTellsBoxAndTeam) {
  World world;
  world.robots.push_back({.foot = {2.0, 0.0}});
  const Seen seen(test::cameras()[1], world, false);
  const auto robots = find_robots(seen.view());
  ASSERT_EQ(robots.size(), 1u);
  EXPECT_EQ(robots[0].team, Team::cyan);
  EXPECT_FALSE(robots[0].floor.has_value());
}

TEST(RobotColors, AreThoseOfTheField) {
  FieldModel::Robots robots;
  EXPECT_EQ(robot_colors(robots),
            class_bit(ColorClass::black) | class_bit(ColorClass::cyan) | class_bit(ColorClass::magenta));
  robots.body = "red";
  robots.markers = {"blue"};
  EXPECT_EQ(robot_colors(robots), class_bit(ColorClass::red) | class_bit(ColorClass::blue));
}

TEST(RobotOptions, RefusesWhatIsOutOfRange) {
  RobotOptions options;
  options.max_step = 0;
  EXPECT_THROW(options.check(), Error);
}

}  // namespace
}  // namespace tassilo
