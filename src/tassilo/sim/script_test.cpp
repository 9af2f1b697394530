#include "tassilo/sim/script.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tassilo/base/error.h"
#include "tassilo/field/field_curves.h"
#include "tassilo/files/field_file.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

TEST(Script, EveryoneStaysOnTheFieldAndApartAndMovesSmoothly) {
  for (const char* name : {"msl98", "rcj_soccer", "msl", "spl"}) {
    const FieldModel field = read_field(name);
    const FieldExtent extent = field_extent(field);
    const ScriptOptions options{.others = 5, .seed = 3};
    const SimMotion motion = scripted_motion(field, options);
    SimState before = motion(0);
    ASSERT_EQ(before.robots.size(), 6U);
    for (int k = 1; k < 400; ++k) {
      const SimState now = motion(k * .05);
      ASSERT_NEAR(now.t, k * .05, 1e-9);
      ASSERT_TRUE(now.ball.at.x > extent.x.low && now.ball.at.x < extent.x.high) << name;
      ASSERT_TRUE(now.ball.at.y > extent.y.low && now.ball.at.y < extent.y.high) << name;
      for (std::size_t i = 0; i < now.robots.size(); ++i) {
        const SimRobot& robot = now.robots[i];
        ASSERT_TRUE(std::abs(robot.at.x) < extent.x.high && std::abs(robot.at.y) < extent.y.high) << name;
        ASSERT_LT(distance(robot.at, before.robots[i].at), .05 * options.speed + .06) << name;
        ASSERT_LE(std::abs(wrap_angle(robot.theta - before.robots[i].theta)), .05 * options.turn + 1e-6);
        for (std::size_t j = i + 1; j < now.robots.size(); ++j)
          ASSERT_GT(distance(robot.at, now.robots[j].at), .8 * (robot.radius + now.robots[j].radius)) << name;
      }
      before = now;
    }
  }
}

TEST(Script, IsTheSameForTheSameSeedHoweverItIsAsked) {
  const FieldModel field = read_field("msl98");
  const SimMotion often = scripted_motion(field, {.seed = 5}), once = scripted_motion(field, {.seed = 5});
  SimState a;
  for (int k = 0; k <= 20; ++k) a = often(k * .1);
  const SimState b = once(2);
  for (std::size_t k = 0; k < a.robots.size(); ++k) EXPECT_NEAR(distance(a.robots[k].at, b.robots[k].at), 0, 1e-6);
  EXPECT_GT(distance(scripted_motion(field, {.seed = 6})(0).robots[0].at, a.robots[0].at), 1e-3);
}

TEST(Script, RobotsAreNumberedAndOfBothTeams) {
  const SimState state = scripted_motion(read_field("msl98"), {.others = 3, .team = Team::magenta, .id = 7})(0);
  EXPECT_EQ(state.robots[0].id, 7);
  EXPECT_EQ(state.robots[0].team, Team::magenta);
  EXPECT_EQ(state.robots[3].id, 10);
  EXPECT_EQ(state.robots[1].team, Team::cyan);
}

TEST(Script, StillsShowOneSceneAfterTheOther) {
  const SimMotion stills = scripted_stills(read_field("msl98"), {.seed = 2});
  const SimState first = stills(0), second = stills(1);
  EXPECT_GT(distance(first.robots[0].at, second.robots[0].at), .01);
  EXPECT_EQ(second.t, 1);
  const FieldPoint to_goal = FieldPoint{4.11, 0} - second.robots[0].at;
  EXPECT_NEAR(wrap_angle(bearing(to_goal) - second.robots[0].theta), 0, 1e-9);
}

TEST(SlippingWheels, DriftButTellTheWayRoughly) {
  SlippingWheels wheels(4);
  RobotMotion sum;
  for (int k = 0; k < 200; ++k) {
    const RobotMotion motion = wheels.measured({.02, 0, .01});
    sum.dx += motion.dx;
    sum.dtheta += motion.dtheta;
  }
  EXPECT_NEAR(sum.dx, 4, .4);
  EXPECT_NEAR(sum.dtheta, 2, .3);
  EXPECT_NE(sum.dx, 4);
}

TEST(Script, OptionsOutOfRangeAreNamed) {
  EXPECT_THROW(ScriptOptions{.others = 21}.check(), Error);
  EXPECT_THROW(ScriptOptions{.speed = NAN}.check(), Error);
  EXPECT_THROW(ScriptOptions{.id = 256}.check(), Error);
}

}  // namespace
}  // namespace tassilo
