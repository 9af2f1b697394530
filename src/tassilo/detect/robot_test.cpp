#include "tassilo/detect/robot.h"

#include <gtest/gtest.h>

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

TEST(FindRobots, WithoutCalibrationItTellsBoxAndTeam) {
  World world;
  world.robots.push_back({.foot = {2.0, 0.0}});
  const Seen seen(test::cameras()[1], world, false);
  const auto robots = find_robots(seen.view());
  ASSERT_EQ(robots.size(), 1u);
  EXPECT_EQ(robots[0].team, Team::cyan);
  EXPECT_FALSE(robots[0].floor.has_value());
}

TEST(RobotOptions, RefusesWhatIsOutOfRange) {
  RobotOptions options;
  options.max_step = 0;
  EXPECT_THROW(options.check(), Error);
}

}  // namespace
}  // namespace tassilo
