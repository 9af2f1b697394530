#include "tassilo/detect/goal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tassilo/detect/test_view.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {
namespace {

using test::Seen;
using test::World;

TEST(FindGoals, PlacesTheMouthOfKnownWidth) {
  for (const MountedCamera& camera : test::cameras())
    for (const double y : {-0.8, 0.0, 0.6}) {
      SCOPED_TRACE(testing::Message() << camera.model().width << " px, middle at y " << y);
      World world;
      world.wall_x = 3;
      world.goal = {{y - 0.75, y + 0.75}};
      const Seen seen(camera, world);
      const auto goals = find_goals(seen.view());
      ASSERT_EQ(goals.size(), 1u);
      EXPECT_EQ(goals[0].color, GoalColor::yellow);
      if (goals[0].box.x0 == 0 || goals[0].box.x1 == camera.model().width) continue;  // cut by the border
      ASSERT_TRUE(goals[0].position.has_value());
      EXPECT_LT(distance(*goals[0].position, {3, y}), 0.15);
      EXPECT_NEAR(degrees(*goals[0].bearing), degrees(std::atan2(y, 3.0)), 0.5);
      ASSERT_EQ(goals[0].posts.size(), 2u);
      EXPECT_GT(goals[0].posts[0].position.y, goals[0].posts[1].position.y);  // left first
    }
}

TEST(FindGoals, AKeeperDoesNotMakeTwoOfIt) {
  World world;
  world.wall_x = 3;
  world.goal = {{-0.75, 0.75}};
  world.robots.push_back({.foot = {2.6, 0.05}, .radius = 0.22, .height = 0.9, .band = 0.3});
  const Seen seen(test::cameras()[1], world);
  const auto goals = find_goals(seen.view());
  ASSERT_EQ(goals.size(), 1u);
  EXPECT_NEAR(degrees(goals[0].bearing.value()), 0, 0.5);
}

// Wherever the camera looks on the robot, also where a post's azimuth jumps from pi to -pi.
TEST(FindGoals, TurningTheMountTurnsTheGoal) {
  World world;
  world.wall_x = 3;
  world.goal = {{-0.6, 0.9}};
  const MountedCamera camera = test::cameras()[1];
  Seen seen(camera, world);
  const auto ahead = find_goals(seen.view());
  ASSERT_EQ(ahead.size(), 1u);
  ASSERT_EQ(ahead[0].posts.size(), 2u);
  const FloorPoint eye = foot_of(camera);
  const double left = bearing(ahead[0].posts[0].position - eye), right = bearing(ahead[0].posts[1].position - eye);
  for (const double angle : {0.5, radians(180), radians(180) - left, radians(180) - right, radians(-100)}) {
    SCOPED_TRACE(degrees(angle));
    seen.optics = Optics(test::turned(camera, angle), seen.optics.mount_sigma);
    const auto aside = find_goals(seen.view());
    ASSERT_EQ(aside.size(), 1u);
    ASSERT_EQ(aside[0].posts.size(), 2u);
    const auto expected = make_pose2<RobotFrame, RobotFrame>(0, 0, angle);
    for (const std::size_t i : {0, 1})
      EXPECT_LT(distance(aside[0].posts[i].position, expected * ahead[0].posts[i].position), 1e-4);
    EXPECT_NEAR(wrap_angle(aside[0].bearing.value() - ahead[0].bearing.value() - angle), 0, 1e-5);
  }
}

TEST(FindGoals, YellowThatDoesNotStandOnTheFloorIsNone) {
  World world;
  world.spheres.push_back({{4.0, 0.5, 0.8}, 0.3, test::kYellow});  // a shirt above the wall
  const Seen seen(test::cameras()[1], world);
  EXPECT_TRUE(find_goals(seen.view()).empty());
}

TEST(SearchGoals, SaysOfEachColorWhyThereIsNone) {
  World world;
  const auto why = [&] {
    Seen seen(test::cameras()[1], world);
    seen.field.goals.push_back({GoalSide::plus_x, GoalColor::blue, 1.5, 0.9, 0.5});
    std::vector<std::string> reasons;
    for (const RecycledString& reason : search_goals(seen.view()).why) reasons.emplace_back(reason);
    return reasons;
  };
  const std::string no_blue = "no blue region of 20 px or more";
  EXPECT_THAT(why(), testing::ElementsAre("no yellow region of 20 px or more", no_blue));
  world.spheres.push_back({{4.0, 0.5, 0.8}, 0.3, test::kYellow});
  EXPECT_THAT(why(), testing::ElementsAre(testing::EndsWith("does not stand on the floor"), no_blue));
  world.spheres.clear();
  world.wall_x = 3;
  world.goal = {{-0.75, 0.75}};
  EXPECT_THAT(why(), testing::ElementsAre(no_blue));
}

}  // namespace
}  // namespace tassilo
