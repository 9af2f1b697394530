#include "tassilo/detect/goal.h"

#include <gtest/gtest.h>

#include "tassilo/detect/test_view.h"
#include "tassilo/geometry/angle.h"

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

TEST(FindGoals, YellowThatDoesNotStandOnTheFloorIsNone) {
  World world;
  world.spheres.push_back({{4.0, 0.5, 0.8}, 0.3, test::kYellow});  // a shirt above the wall
  const Seen seen(test::cameras()[1], world);
  EXPECT_TRUE(find_goals(seen.view()).empty());
}

}  // namespace
}  // namespace tassilo
