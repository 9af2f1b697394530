#include "tassilo/behavior/player.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

FieldModel walled_field() {
  FieldModel field;
  field.length = 8.22;
  field.width = 4.575;
  field.goals = {{GoalSide::plus_x, GoalColor::blue, 1.5, 0.9, 0.5},
                 {GoalSide::minus_x, GoalColor::yellow, 1.5, 0.9, 0.5}};
  field.walls = FieldModel::Walls{"white", 0.5, {-4.11, 4.11}, {-2.2875, 2.2875}};
  return field;
}

PoseSeen pose_at(FieldPoint at, double theta) {
  PoseSeen pose{at.x, at.y, theta, {}, PoseKind::two_lines, 0, false};
  pose.covariance[0] = pose.covariance[4] = pose.covariance[8] = 1e-4;
  return pose;
}
TrackSeen track_at(TrackKind kind, FloorPoint p, Team team = Team::unknown) {
  TrackSeen track;
  track.id = 1;
  track.kind = kind;
  track.team = team;
  track.x = p.x;
  track.y = p.y;
  return track;
}
/// Floor ahead that is free as far as this; blocked there, else unknown.
FreeSpace floor_to(double range, bool is_blocked) {
  FreeSpace space;
  space.angle_increment = radians(2);
  space.angle_min = radians(-44);
  for (int k = 0; k < 45; ++k) {
    space.ranges.push_back(range);
    space.states.push_back(is_blocked ? SectorState::blocked : SectorState::free);
  }
  return space;
}

/// Where things are, field frame.
struct Setting {
  FieldPoint at{0, 0};
  double theta = 0;
  std::optional<FieldPoint> ball = {};
  std::vector<FieldPoint> others = {};
  std::optional<FreeSpace> floor = floor_to(5, false);
  GoalSide own_goal = GoalSide::minus_x;
};

Scene scene_of(const Setting& setting, double t = 1) {
  Scene scene;
  scene.t = t;
  scene.pose = pose_at(setting.at, setting.theta);
  const auto robot_from_field = inverse(make_pose2<FieldFrame, RobotFrame>(setting.at.x, setting.at.y, setting.theta));
  if (setting.ball) scene.tracks.push_back(track_at(TrackKind::ball, robot_from_field * *setting.ball));
  for (const FieldPoint other : setting.others)
    scene.tracks.push_back(track_at(TrackKind::robot, robot_from_field * other, Team::magenta));
  scene.free_space = setting.floor;
  return scene;
}

PlayerOutput first_step(const Scene& scene, GoalSide own_goal, const PlayerOptions& options = {}) {
  const FieldModel field = walled_field();
  PlayerInput input;
  input.id = 2;
  input.team = Team::cyan;
  input.own_goal = own_goal;
  input.t = scene.t;
  input.scene = &scene;
  input.field = &field;
  return play({}, input, options).output;
}
PlayerOutput first_step(const Setting& setting, const PlayerOptions& options = {}) {
  return first_step(scene_of(setting), setting.own_goal, options);
}

double speed_of(const PlayerOutput& output) { return (output.wheels.left + output.wheels.right) / 2; }
double turn_of(const PlayerOutput& output) { return output.wheels.right - output.wheels.left; }

Setting random_setting(std::mt19937& random) {
  std::uniform_real_distribution<double> x(-3.8, 3.8), y(-2, 2), angle(-3, 3);
  Setting setting;
  setting.at = {x(random), y(random)};
  setting.theta = angle(random);
  setting.ball = FieldPoint{x(random), y(random)};
  for (int k = 0; k < 3; ++k) setting.others.push_back({x(random), y(random)});
  return setting;
}

TEST(Player, WhatSeesNothingTurnsOnTheSpotAndKicksNothing) {
  const FieldModel field = walled_field();
  for (const bool is_goalkeeper : {false, true})
    for (const bool is_picture : {false, true}) {
      PlayerOptions options;
      options.is_goalkeeper = is_goalkeeper;
      PlayerState state;
      for (int k = 0; k < 2000; ++k) {
        Scene black;
        black.t = 0.05 * k;
        PlayerInput input;
        input.id = 1;
        input.t = black.t + 0.05;
        input.scene = is_picture ? &black : nullptr;
        input.field = &field;
        // Not even when the team tells where the ball is.
        input.ball = ToldBall{{{1, 1}, 0.01 * Eigen::Matrix2d::Identity()}, 0, 0, 0.1};
        const PlayerStep step = play(state, input, options);
        state = step.state;
        ASSERT_NEAR(speed_of(step.output), 0, 1e-12);
        ASSERT_FALSE(step.output.wheels.is_kick);
        ASSERT_EQ(step.output.action, "localize");
      }
    }
}

TEST(Player, PlaysTheOtherWayWhenTheFieldIsTurned) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Setting setting = random_setting(random);
    Setting turned = setting;
    turned.own_goal = GoalSide::plus_x;
    turned.theta = wrap_angle(setting.theta + std::numbers::pi);
    turned.at = -1 * setting.at;
    turned.ball = -1 * *setting.ball;
    for (FieldPoint& other : turned.others) other = -1 * other;
    for (const bool is_goalkeeper : {false, true}) {
      PlayerOptions options;
      options.is_goalkeeper = is_goalkeeper;
      const PlayerOutput one = first_step(setting, options), two = first_step(turned, options);
      EXPECT_NEAR(one.wheels.left, two.wheels.left, 1e-6);
      EXPECT_NEAR(one.wheels.right, two.wheels.right, 1e-6);
      EXPECT_EQ(one.wheels.is_kick, two.wheels.is_kick);
      EXPECT_EQ(one.action, two.action);
    }
  }
}

TEST(Player, NeverDrivesFasterThanItCanStopOnFloorThatWasSeenFree) {
  const PlayerOptions options;
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Setting setting = random_setting(random);
    setting.ball->x = std::clamp(setting.ball->x, setting.at.x - 2, setting.at.x + 2);
    setting.floor.reset();
    EXPECT_LE(speed_of(first_step(setting)), 1e-9);
    for (const double range : {0.3, 0.5, 1.}) {
      setting.floor = floor_to(range, true);
      // Floor that ends at the ball does not count; so the ball is elsewhere.
      if (distance(*setting.ball, setting.at) < range + 0.5) continue;
      EXPECT_LE(speed_of(first_step(setting)), std::sqrt(2 * options.acceleration * (range - options.radius)) + 1e-9);
    }
  }
}

TEST(Player, ShootsWhenTheBallLiesBeforeItAndTheGoalBehindThat) {
  const double touch = 0.225 + 0.105;
  const PlayerOutput shot = first_step(Setting{.at = {1.5, 0}, .theta = 0, .ball = FieldPoint{1.5 + touch + 0.02, 0}});
  EXPECT_TRUE(shot.wheels.is_kick);
  EXPECT_EQ(shot.action, "shoot");
  EXPECT_EQ(shot.role, Role::striker);
  // Not beside it, and never to the own goal.
  EXPECT_FALSE(
      first_step(Setting{.at = {1.5, 0}, .theta = 0.6, .ball = FieldPoint{1.5 + touch * 0.83, 0.19}}).wheels.is_kick);
  EXPECT_FALSE(first_step(Setting{.at = {1.5, 0}, .theta = std::numbers::pi, .ball = FieldPoint{1.5 - touch - 0.02, 0}})
                   .wheels.is_kick);
  EXPECT_FALSE(
      first_step(Setting{.at = {1.5, 0}, .ball = FieldPoint{1.5 + touch + 0.02, 0}, .own_goal = GoalSide::plus_x})
          .wheels.is_kick);
}

TEST(Player, WithoutAPoseBallAndGoalInViewAreEnough) {
  Scene scene = scene_of({.ball = FieldPoint{0.35, 0}});
  scene.pose.reset();
  EXPECT_EQ(first_step(scene, GoalSide::minus_x).action, "localize");
  Goal goal;
  goal.color = GoalColor::blue;
  goal.position = FloorPoint{2.5, 0.1};
  scene.goals.push_back(goal);
  EXPECT_EQ(first_step(scene, GoalSide::minus_x).action, "shoot");
  EXPECT_EQ(first_step(scene, GoalSide::plus_x).action, "localize");
}

TEST(Player, APoseThatIsOldOrVagueOrMaybeMirroredIsNone) {
  for (const int fault : {0, 1, 2}) {
    Scene scene = scene_of({.ball = FieldPoint{2, 0}});
    if (fault == 0) scene.pose->age = 100;
    if (fault == 1) scene.pose->covariance[0] = 4;
    if (fault == 2) scene.pose->mirror = true;
    EXPECT_EQ(first_step(scene, GoalSide::minus_x).action, "localize");
  }
}

TEST(Player, GoesAroundARobotThatStandsInTheWay) {
  const PlayerOutput free = first_step(Setting{.at = {-2, 0}, .ball = FieldPoint{2, 0}});
  EXPECT_NEAR(turn_of(free), 0, 0.05);
  EXPECT_GT(speed_of(free), 0.8);
  const PlayerOutput left = first_step(Setting{.at = {-2, 0}, .ball = FieldPoint{2, 0}, .others = {{-1.2, -0.1}}});
  EXPECT_GT(turn_of(left), 0.1);
  const PlayerOutput right = first_step(Setting{.at = {-2, 0}, .ball = FieldPoint{2, 0}, .others = {{-1.2, 0.1}}});
  EXPECT_LT(turn_of(right), -0.1);
}

TEST(Player, TheBallThatOnlyTheTeamSeesIsGoneTo) {
  const FieldModel field = walled_field();
  const Scene scene = scene_of({.at = {-2, 0}});
  PlayerInput input;
  input.id = 2;
  input.t = 1;
  input.scene = &scene;
  input.field = &field;
  EXPECT_EQ(play({}, input, {}).output.action, "search");
  input.ball = ToldBall{{{1, 0}, 0.01 * Eigen::Matrix2d::Identity()}, 0, 0, 0.2};
  EXPECT_EQ(play({}, input, {}).output.action, "go_to_ball");
  input.ball->age = 10;
  EXPECT_EQ(play({}, input, {}).output.action, "search");
}

TEST(Player, TheGoalkeeperGoesBetweenBallAndGoalAndDoesNotGoToAFarBall) {
  PlayerOptions options;
  options.is_goalkeeper = true;
  const PlayerOutput home =
      first_step(Setting{.at = {-1, 0}, .theta = std::numbers::pi, .ball = FieldPoint{0, 0}}, options);
  EXPECT_EQ(home.role, Role::goalkeeper);
  EXPECT_EQ(home.action, "keep_goal");
  EXPECT_GT(speed_of(home), 0.3);
  const PlayerOutput there = first_step(Setting{.at = {-3.7, 0}, .ball = FieldPoint{0, 0}}, options);
  EXPECT_NEAR(speed_of(there), 0, 1e-9);
  EXPECT_EQ(there.planning_state, "watch the ball");
}

TEST(Player, OneThatDoesNotGetOnBacksOut) {
  const FieldModel field = walled_field();
  PlayerState state;
  bool has_backed = false;
  for (int k = 0; k < 60; ++k) {
    const Scene scene = scene_of({.at = {-2, 0}, .ball = FieldPoint{2, 0}}, 0.05 * k);
    PlayerInput input;
    input.id = 2;
    input.t = scene.t;
    input.scene = &scene;
    input.field = &field;
    const PlayerStep step = play(state, input, {});
    state = step.state;
    if (step.output.action != "recover") continue;
    has_backed = true;
    EXPECT_LE(speed_of(step.output), 0);
    EXPECT_GE(speed_of(step.output), -0.3);
  }
  EXPECT_TRUE(has_backed);
}

TEST(Player, WheelsStayWithinTheirSpeed) {
  const PlayerOptions options;
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    const PlayerOutput output = first_step(random_setting(random));
    for (const double wheel : {output.wheels.left, output.wheels.right})
      EXPECT_LE(std::abs(wheel), options.max_speed + 1e-9);
    EXPECT_LE(std::abs(turn_of(output)) / options.wheel_base, options.max_turn_rate + 1e-9);
  }
}

TEST(Player, OptionsOutOfRangeAreRefused) {
  for (double PlayerOptions::*option :
       {&PlayerOptions::radius, &PlayerOptions::wheel_base, &PlayerOptions::max_speed, &PlayerOptions::acceleration,
        &PlayerOptions::max_turn_rate, &PlayerOptions::stuck_way})
    for (const double value : {0., -1.}) {
      PlayerOptions options;
      options.*option = value;
      EXPECT_THROW(options.check(), Error);
    }
}

}  // namespace
}  // namespace tassilo
