#include "tassilo/sim/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/field/field_curves.h"
#include "tassilo/files/field_file.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {
namespace {

FieldModel shipped(const std::string& name) {
  return read_field(std::string(TASSILO_SOURCE_DIR) + "/config/fields/" + name + ".yaml");
}
std::vector<std::string> shipped_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(TASSILO_SOURCE_DIR) + "/config/fields"))
    names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

WorldOptions without_noise() {
  WorldOptions options;
  options.slip_sigma = options.wheel_sigma = options.kick_sigma_deg = 0;
  return options;
}

double ball_speed(const World& world) { return std::hypot(world.state().ball.vx, world.state().ball.vy); }

/// Commands that change every quarter of a second and now and then kick.
std::vector<RobotCommand> random_commands(const World& world, std::mt19937& random) {
  std::uniform_real_distribution<double> speed(-1.5, 1.5);
  std::vector<RobotCommand> commands;
  for (const SimRobot& robot : world.state().robots) {
    const double left = speed(random), right = speed(random);
    commands.push_back({robot.id, {left, right, speed(random) > 1}});
  }
  return commands;
}

/// How deep the worst pair of things is in one another. [m]
double deepest_overlap(const World& world) {
  double deepest = 0;
  const auto& [t, ball, robots] = world.state();
  const auto into_barriers = [&](FieldPoint at, double radius) {
    for (const auto& [p, q] : world.barriers()) {
      const double share = std::clamp(dot(at - p, q - p) / dot(q - p, q - p), 0., 1.);
      deepest = std::max(deepest, radius - distance(at, p + share * (q - p)));
    }
  };
  into_barriers(ball.at, ball.radius);
  for (std::size_t a = 0; a < robots.size(); ++a) {
    into_barriers(robots[a].at, robots[a].radius);
    deepest = std::max(deepest, robots[a].radius + ball.radius - distance(robots[a].at, ball.at));
    for (std::size_t b = 0; b < a; ++b)
      deepest = std::max(deepest, robots[a].radius + robots[b].radius - distance(robots[a].at, robots[b].at));
  }
  return deepest;
}

std::vector<std::uint64_t> bits_of(const SimState& state) {
  std::vector<std::uint64_t> bits;
  const auto add = [&](double value) { bits.push_back(std::bit_cast<std::uint64_t>(value)); };
  for (const double value : {state.t, state.ball.at.x, state.ball.at.y, state.ball.vx, state.ball.vy}) add(value);
  for (const SimRobot& robot : state.robots)
    for (const double value : {robot.at.x, robot.at.y, robot.theta, robot.speed, robot.turn}) add(value);
  return bits;
}

World with_teams(const FieldModel& field, const WorldOptions& options, int each) {
  World world(field, options);
  for (int k = 0; k < each; ++k) {
    world.add(1 + k, Team::cyan);
    world.add(11 + k, Team::magenta);
  }
  return world;
}

TEST(World, ABallThatRollsFreelyStopsAfterTheSquareOfItsSpeedOverTwiceTheFriction) {
  for (const double v : {0.1, 0.7, 1.2}) {
    SCOPED_TRACE(v);
    World world(shipped("msl98"));
    world.place_ball({-2, 0.3}, v * std::cos(0.2), v * std::sin(0.2));
    world.step(v / world.options().ball_friction + 0.1, {});
    EXPECT_EQ(ball_speed(world), 0);
    const FieldPoint at = world.state().ball.at;
    const double way = v * v / (2 * world.options().ball_friction);
    EXPECT_NEAR(at.x, -2 + way * std::cos(0.2), 1e-9);
    EXPECT_NEAR(at.y, 0.3 + way * std::sin(0.2), 1e-9);
  }
}

TEST(World, ABallLeavesAWallWithItsWayAlongItAndItsShareOfTheWayAcross) {
  for (const double angle : {20., 45., 80.}) {
    SCOPED_TRACE(angle);
    WorldOptions options;
    options.ball_friction = 1e-9;
    World world(shipped("msl98"), options);
    const double v = 2, along = v * std::cos(radians(angle)), across = v * std::sin(radians(angle));
    world.place_ball({-1, 2}, along, across);
    world.step(0.6, {});
    EXPECT_NEAR(world.state().ball.vx, along, 1e-6);
    EXPECT_NEAR(world.state().ball.vy, -options.wall_restitution * across, 1e-6);
  }
}

TEST(World, EnergyGrowsOnlyByWheelsAndKicks) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> speed(-6, 6);
  for (const char* field : {"msl98", "rcj_soccer_walls", "spl"}) {
    SCOPED_TRACE(field);
    World world = with_teams(shipped(field), {}, 3);
    for (int k = 0; k < 20; ++k) {
      world.place_ball({0, 0.01 * world.field().width}, speed(random), speed(random));
      double before = ball_speed(world);
      for (int tick = 0; tick < 1000; ++tick) {
        if (!world.step(World::kTick, {}).empty()) break;
        ASSERT_LE(ball_speed(world), before + 1e-9);
        before = ball_speed(world);
      }
      // What stands stays where it is.
      for (const SimRobot& robot : world.state().robots) EXPECT_EQ(robot.speed, 0);
    }
  }
}

TEST(World, NothingIsTunnelledThroughHoweverFastTheBallIs) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
  for (const double v : {5., 50., 500.})
    for (int k = 0; k < 30; ++k) {
      SCOPED_TRACE(v);
      World world = with_teams(shipped("msl98"), {}, 4);
      const double a = angle(random);
      world.place_ball({0, 0}, v * std::cos(a), v * std::sin(a));
      for (int tick = 0; tick < 300; ++tick) {
        world.step(World::kTick, {});
        ASSERT_LE(deepest_overlap(world), 1e-6);
        const FieldPoint at = world.state().ball.at;
        ASSERT_LT(std::abs(at.y), world.field().walls->y.high);
        ASSERT_LT(std::abs(at.x), world.field().length / 2 + world.field().goals[0].depth);
      }
    }
}

TEST(World, ARobotIsFasterByItsAccelerationUntilItHasTheSpeedThatWasAsked) {
  World world(shipped("msl98"), without_noise());
  world.add(1, Team::cyan);
  world.place(1, {-2, 1}, 0);
  const std::vector<RobotCommand> forward{{1, {0.8, 0.8}}};
  world.step(0.2, forward);
  EXPECT_NEAR(world.state().robots[0].speed, 0.2 * world.options().max_wheel_acceleration, 0.003);
  world.step(0.8, forward);
  EXPECT_NEAR(world.state().robots[0].speed, 0.8, 1e-9);
  // Without a command it brakes.
  world.step(1, {});
  EXPECT_EQ(world.state().robots[0].speed, 0);
  // Wheels against each other turn it by their difference over their distance.
  world.step(1, std::vector<RobotCommand>{{1, {-0.1, 0.1}}});
  EXPECT_NEAR(world.state().robots[0].turn, 0.2 / world.wheel_base(1), 1e-9);
  EXPECT_NEAR(world.state().robots[0].speed, 0, 1e-9);
}

TEST(World, WithoutSlipOdometryIsTheTruth) {
  std::mt19937 random(7);
  World world(shipped("msl"), without_noise());
  world.add(1, Team::cyan);
  world.place(1, {-3, 2}, 1);
  const auto field_from_odometry = make_pose2<FieldFrame, RobotFrame>(-3, 2, 1);
  for (int k = 0; k < 40; ++k) {
    world.step(0.25, random_commands(world, random));
    const OdometrySample told = world.odometry(1);
    const SimRobot& robot = world.state().robots[0];
    EXPECT_EQ(told.t, world.state().t);
    EXPECT_NEAR(distance(field_from_odometry * FloorPoint{told.x, told.y}, robot.at), 0, 1e-9);
    EXPECT_NEAR(wrap_angle(told.theta + 1 - robot.theta), 0, 1e-9);
  }
}

TEST(World, WithSlipOdometryDriftsByItsShareAndNeverJumps) {
  double drift = 0;
  constexpr int kSeeds = 20;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(seed);
    WorldOptions options;
    options.seed = static_cast<std::uint64_t>(seed);
    World world(shipped("msl"), options);
    world.add(1, Team::cyan);
    world.place(1, {-5, 3}, 0);
    OdometrySample last = world.odometry(1);
    for (int k = 0; k < 500; ++k) {
      world.step(0.02, std::vector<RobotCommand>{{1, {0.8, 0.8}}});
      const OdometrySample told = world.odometry(1);
      ASSERT_LE(std::hypot(told.x - last.x, told.y - last.y), 0.02 * options.max_wheel_speed + 1e-9);
      last = told;
    }
    drift += std::abs(wrap_angle(last.theta - world.state().robots[0].theta)) / kSeeds;
  }
  // 8 m straight on: some degrees.
  EXPECT_GT(degrees(drift), 1);
  EXPECT_LT(degrees(drift), 25);
}

TEST(World, AGuidedBallStaysBeforeARobotThatDrivesAndIsLostWhenItStops) {
  World world(shipped("msl98"), without_noise());
  world.add(1, Team::cyan);
  world.place(1, {-3, 0}, 0);
  const double least = world.state().robots[0].radius + world.state().ball.radius;
  world.place_ball({-3 + least + 0.01, 0.05}, 0, 0);
  world.step(3, std::vector<RobotCommand>{{1, {0.7, 0.8}}});
  const SimRobot& robot = world.state().robots[0];
  EXPECT_GT(robot.at.x, -2);
  EXPECT_LT(distance(world.state().ball.at, robot.at), least + 0.01);
  EXPECT_LT(std::abs(wrap_angle(bearing(world.state().ball.at - robot.at) - robot.theta)), radians(25));
  world.step(1, {});
  EXPECT_GT(distance(world.state().ball.at, world.state().robots[0].at), least + 0.1);
}

TEST(World, AKickMovesABallThatLiesBeforeTheRobotAndNoOther) {
  for (const double at_deg : {0., 20., 60., 180.}) {
    SCOPED_TRACE(at_deg);
    World world(shipped("msl98"), without_noise());
    world.add(1, Team::cyan);
    world.place(1, {-1, 0}, 0.3);
    const double least = world.state().robots[0].radius + world.state().ball.radius + 0.01, a = 0.3 + radians(at_deg);
    world.place_ball({-1 + least * std::cos(a), least * std::sin(a)}, 0, 0);
    world.step(World::kTick, std::vector<RobotCommand>{{1, {0, 0, true}}});
    const SimBall& ball = world.state().ball;
    if (at_deg < 25) {
      EXPECT_NEAR(ball_speed(world), world.options().kick_speed, 0.01);
      EXPECT_NEAR(std::atan2(ball.vy, ball.vx), 0.3, 1e-9);
    } else {
      EXPECT_EQ(ball_speed(world), 0);
    }
  }
}

TEST(World, AGoalIsCountedOnceForTheTeamThatDoesNotDefendItAndTheOthersKickOff) {
  for (const GoalSide own : {GoalSide::minus_x, GoalSide::plus_x})
    for (const double side : {1., -1.}) {
      WorldOptions options;
      options.cyan_own_goal = own;
      World world = with_teams(shipped("msl98"), options, 2);
      world.place_ball({side * 3, 0.5}, side * 3, 0);
      std::vector<RefereeEvent> goals, kick_offs;
      for (int k = 0; k < 100; ++k)
        for (const RefereeEvent& event : world.step(0.05, {}))
          (event.call == RefereeCall::goal ? goals : kick_offs).push_back(event);
      const bool is_cyans = (own == GoalSide::minus_x) == (side > 0);
      ASSERT_EQ(goals.size(), 1u);
      EXPECT_EQ(goals[0].team, is_cyans ? Team::cyan : Team::magenta);
      EXPECT_EQ(world.score(), (is_cyans ? Score{1, 0} : Score{0, 1}));
      ASSERT_EQ(kick_offs.size(), 2u);  // The match's first one, and that after the goal.
      EXPECT_EQ(kick_offs[1].team, is_cyans ? Team::magenta : Team::cyan);
      EXPECT_EQ(world.state().ball.at, (FieldPoint{0, 0}));
    }
}

TEST(World, ABallBesideTheGoalIsNoneAndAGoalPostIsInTheWay) {
  World world(shipped("msl98"));
  world.place_ball({3, 1.5}, 3, 0);
  world.step(2, {});
  EXPECT_EQ(world.score(), Score{});
  EXPECT_LT(world.state().ball.at.x, 4.11);
  // Free-standing goals before a wall are the same, also from behind.
  World small(shipped("rcj_soccer_walls"));
  small.place_ball({1.19, 0.5}, 0, -2);
  small.step(2, {});
  EXPECT_EQ(small.score(), Score{});
  small.place_ball({0.9, 0.2}, 2, 0);
  small.step(1, {});
  EXPECT_EQ(small.score().cyan, 1);
}

TEST(World, WithoutWallsTheBallIsOutBehindALineAndComesBackToANeutralSpot) {
  for (const char* field : {"msl", "rcj_soccer", "humanoid_kid"})
    for (const double angle : {30., 90., 200.}) {
      SCOPED_TRACE(field);
      World world(shipped(field));
      world.place_ball({0, 0}, 8 * std::cos(radians(angle)), 8 * std::sin(radians(angle)));
      std::vector<RefereeEvent> calls;
      for (int k = 0; k < 400 && calls.size() < 2; ++k)
        for (const RefereeEvent& event : world.step(0.01, {})) calls.push_back(event);
      ASSERT_EQ(calls.size(), 2u);  // After the kick-off.
      EXPECT_EQ(calls[1].call, RefereeCall::ball_out);
      EXPECT_EQ(ball_speed(world), 0);
      const FieldPoint at = world.state().ball.at;
      EXPECT_LT(std::abs(at.x), world.field().length / 2);
      EXPECT_LT(std::abs(at.y), world.field().width / 2);
    }
}

TEST(World, AStuckBallGoesToAnotherPlace) {
  World world(shipped("msl98"));
  world.place_ball({3.9, 2.1}, 0, 0);
  EXPECT_TRUE(world.step(world.options().stuck_s - 0.1, {}).size() == 1);
  const auto calls = world.step(0.2, {});
  ASSERT_EQ(calls.size(), 1u);
  EXPECT_EQ(calls[0].call, RefereeCall::stuck_ball);
  EXPECT_GT(distance(world.state().ball.at, FieldPoint{3.9, 2.1}), 0.3);
}

TEST(World, WhatHappensDoesNotDependOnHowTimeIsCut) {
  const auto after = [](const std::vector<double>& cuts) {
    World world = with_teams(shipped("msl98"), {}, 4);
    std::mt19937 random(9);
    for (int k = 0; k < 20; ++k) {
      const auto commands = random_commands(world, random);
      for (const double cut : cuts) world.step(cut, commands);
    }
    return bits_of(world.state());
  };
  const auto whole = after({0.3});
  EXPECT_EQ(whole, after({0.1, 0.2}));
  EXPECT_EQ(whole, after({0.0004, 0.1996, 0.05, 0.05}));
  EXPECT_EQ(whole, after(std::vector<double>(9, 0.3 / 9)));
}

TEST(World, TheSameSeedIsTheSameMatchToTheLastBit) {
  const auto match = [](std::uint64_t seed) {
    WorldOptions options;
    options.seed = seed;
    World world = with_teams(shipped("msl98"), options, 4);
    std::mt19937 random(1);
    for (int k = 0; k < 80; ++k) world.step(0.25, random_commands(world, random));
    return bits_of(world.state());
  };
  EXPECT_EQ(match(4), match(4));
  EXPECT_NE(match(4), match(5));
}

TEST(World, RobotsComeAndGoWhileItRuns) {
  World world = with_teams(shipped("msl98"), {}, 3);
  std::mt19937 random(2);
  for (int k = 0; k < 40; ++k) {
    world.step(0.25, random_commands(world, random));
    if (k % 2 == 0) {
      world.remove(2);
      EXPECT_THROW(world.odometry(2), Error);
    } else {
      world.add(2, Team::cyan);
      EXPECT_EQ(world.odometry(2).x, 0);
    }
    ASSERT_LE(deepest_overlap(world), 1e-6);
    EXPECT_TRUE(std::ranges::is_sorted(world.state().robots, {}, &SimRobot::id));
  }
  EXPECT_THROW(world.add(1, Team::cyan), Error);
  EXPECT_THROW(world.add(300, Team::cyan), Error);
  EXPECT_THROW(world.add(9, Team::unknown), Error);
  EXPECT_THROW(world.remove(77), Error);
}

TEST(World, TwoThatPushAgainstEachOtherWithTheBallBetweenKeepApart) {
  World world(shipped("msl98"), without_noise());
  world.add(1, Team::cyan);
  world.add(11, Team::magenta);
  world.place(1, {-1, 0}, 0);
  world.place(11, {1, 0}, std::numbers::pi);
  world.place_ball({0, 0}, 0, 0);
  for (int k = 0; k < 5000; ++k) {
    world.step(World::kTick, std::vector<RobotCommand>{{1, {1, 1}}, {11, {1, 1}}});
    ASSERT_LE(deepest_overlap(world), 1e-6);
  }
}

TEST(World, ABallBetweenARobotAndAWallStopsTheRobot) {
  World world(shipped("msl98"), without_noise());
  world.add(1, Team::cyan);
  world.place(1, {0, 1.5}, std::numbers::pi / 2);
  world.place_ball({0, 2.1}, 0, 0);
  for (int k = 0; k < 3000; ++k) {
    world.step(World::kTick, std::vector<RobotCommand>{{1, {1, 1}}});
    ASSERT_LE(deepest_overlap(world), 1e-6);
    ASSERT_LE(ball_speed(world), 3);
  }
}

TEST(World, EveryShippedFieldIsPlayedOnForAMinuteByRobotsThatDriveAtRandom) {
  for (const std::string& name : shipped_names()) {
    SCOPED_TRACE(name);
    World world = with_teams(shipped(name), {}, 4);
    std::mt19937 random(11);
    const FieldExtent extent = field_extent(world.field());
    const double out = world.field().walls ? 0.6 : world.options().run_off;
    for (int k = 0; k < 240; ++k) {
      const auto commands = random_commands(world, random);
      for (int part = 0; part < 10; ++part) {
        world.step(0.025, commands);
        ASSERT_LE(deepest_overlap(world), 1e-6);
        for (const SimRobot& robot : world.state().robots) {
          ASSERT_LT(robot.at.x, extent.x.high + out);
          ASSERT_GT(robot.at.x, extent.x.low - out);
          ASSERT_LT(std::abs(robot.at.y), extent.y.high + out);
          ASSERT_TRUE(std::isfinite(robot.theta) && std::isfinite(robot.speed) && std::isfinite(robot.turn));
        }
        ASSERT_LT(ball_speed(world), 15);
      }
    }
    EXPECT_NEAR(world.state().t, 60, 1e-9);
  }
}

TEST(World, AtKickOffAllStandInTheirOwnHalfOutOfTheCircleButOne) {
  for (const std::string& name : shipped_names())
    for (int robots = 1; robots <= 5; ++robots)
      for (const GoalSide own : {GoalSide::minus_x, GoalSide::plus_x})
        for (const bool has_kick_off : {false, true}) {
          SCOPED_TRACE(name + " " + std::to_string(robots));
          const FieldModel field = shipped(name);
          const double radius = field.robots.width.middle() / 2, side = own == GoalSide::plus_x ? 1 : -1;
          const auto places = kick_off_places(field, own, robots, has_kick_off);
          ASSERT_EQ(places.size(), static_cast<std::size_t>(robots));
          int within_circle = 0;
          for (const KickOffPlace& place : places) {
            EXPECT_GT(side * place.at.x, radius);
            EXPECT_LT(side * place.at.x, field.length / 2 - radius);
            EXPECT_LT(std::abs(place.at.y), field.width / 2 - radius);
            EXPECT_NEAR(std::cos(place.theta), -side, 1e-9);
            within_circle += norm(place.at) < field.circle_radius + radius;
          }
          EXPECT_LE(within_circle, has_kick_off ? 1 : 0);
        }
  EXPECT_THROW(kick_off_places(shipped("rcj_soccer"), GoalSide::minus_x, 100, true), Error);
}

TEST(World, OptionsOutOfRangeAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double WorldOptions::*option :
       {&WorldOptions::ball_friction, &WorldOptions::wheel_base, &WorldOptions::guide_deg,
        &WorldOptions::max_wheel_speed, &WorldOptions::stuck_s, &WorldOptions::run_off})
    for (const double value : {0., -1., nan}) {
      WorldOptions options;
      options.*option = value;
      EXPECT_THROW(options.check(), Error);
    }
  for (double WorldOptions::*option : {&WorldOptions::wall_restitution, &WorldOptions::robot_restitution,
                                       &WorldOptions::slip_sigma, &WorldOptions::kick_speed})
    for (const double value : {-0.1, nan}) {
      WorldOptions options;
      options.*option = value;
      EXPECT_THROW(options.check(), Error);
    }
}

}  // namespace
}  // namespace tassilo
