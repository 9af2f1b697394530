#include "tassilo/message/plausible.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tassilo/message/from_scene.h"

namespace tassilo {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const ros::Header kOfRobot3{{1'700'000'000, 5}, "robot3/base_link"};

TEST(Implausible, WhatOurScenesBecomeIsNot) {
  Scene scene;
  scene.pose.emplace();
  scene.pose->covariance = {1, .5, 0, .5, 1, 0, 0, 0, .1};
  scene.balls.emplace_back();
  scene.balls.back().floor.emplace();
  scene.balls.back().floor->bounds.far = HUGE_VAL;
  scene.robots.emplace_back();
  scene.robots.back().floor.emplace();
  scene.goals.emplace_back();
  scene.goals.back().bearing = 1;
  scene.lines.emplace_back();
  scene.lines.back().floor.emplace();
  scene.circles.emplace_back();
  scene.tracks.emplace_back();
  scene.free_space.emplace();
  scene.free_space->ranges.push_back(8);
  scene.free_space->states.push_back(SectorState::free);
  scene.free_space->ranges.push_back(kNan);
  scene.free_space->states.push_back(SectorState::unseen);
  const MessageContext context{.robot = 3};
  const ros::Time stamp{1'700'000'000, 5};
  EXPECT_THAT(implausible(pose_message(*scene.pose, stamp), 3), IsEmpty());
  EXPECT_THAT(implausible(balls_message(scene, stamp, context), 3), IsEmpty());
  EXPECT_THAT(implausible(robots_message(scene, stamp, context), 3), IsEmpty());
  EXPECT_THAT(implausible(goals_message(scene, stamp, context), 3), IsEmpty());
  EXPECT_THAT(implausible(lines_message(scene, stamp, context), 3), IsEmpty());
  EXPECT_THAT(implausible(tracks_message(scene, stamp, context), 3), IsEmpty());
  EXPECT_THAT(implausible(free_space_message(*scene.free_space, stamp, context), 3), IsEmpty());
  EXPECT_THAT(implausible(team_state_message(scene, stamp, context), 3), IsEmpty());
  EXPECT_THAT(implausible(balls_message(scene, stamp, context), 4), HasSubstr("robot4/base_link"));
}

TEST(Implausible, ABallMustBeSomewhere) {
  msgs::BallArray balls{kOfRobot3, {{}}};
  EXPECT_THAT(implausible(balls, 3), IsEmpty());
  for (const double x : {kNan, HUGE_VAL, -1000.}) {
    balls.balls[0].center.x = x;
    EXPECT_THAT(implausible(balls, 3), HasSubstr("ball"));
  }
  balls.balls[0] = {};
  balls.balls[0].confidence = 1.5;
  EXPECT_THAT(implausible(balls, 3), HasSubstr("confidence"));
  balls.balls.assign(101, {});
  EXPECT_THAT(implausible(balls, 3), HasSubstr("too many balls"));
}

TEST(Implausible, ACovarianceIsOne) {
  msgs::BallArray balls{kOfRobot3, {{}}};
  for (const std::array<double, 4>& wrong :
       {std::array<double, 4>{-1, 0, 0, 1}, {1, .5, .4, 1}, {1, 2, 2, 1}, {kNan, 0, 0, 1}}) {
    balls.balls[0].covariance = wrong;
    EXPECT_THAT(implausible(balls, 3), HasSubstr("varia"));
  }
  balls.balls[0].covariance = {1, .99, .99, 1};
  EXPECT_THAT(implausible(balls, 3), IsEmpty());
}

TEST(Implausible, ATextCanBeShown) {
  msgs::TeamState state;
  state.header = kOfRobot3;
  state.robot = 3;
  state.role = "Stürmer 前锋 🤖";
  EXPECT_THAT(implausible(state, 3), IsEmpty());
  for (const std::string& wrong :
       {std::string("a\nb"), std::string("\xff"), std::string("\xc3"), std::string("\xed\xa0\x80"),
        std::string("\xe0\x80\x80"), std::string("\xf4\x90\x80\x80"), std::string("\xc2\x80"),
        std::string("a\xe2\x80\xae"), std::string(1, '\0'), std::string(101, 'a')}) {
    state.role = wrong;
    EXPECT_THAT(implausible(state, 3), HasSubstr("role"));
  }
  state.role = "";
  state.robot = 4;
  EXPECT_THAT(implausible(state, 3), HasSubstr("robot 4"));
}

TEST(Implausible, RangesBelongToStates) {
  msgs::FreeSpace space;
  space.header = kOfRobot3;
  space.range_max = 8;
  space.ranges = {1, 2};
  space.states = {1};
  EXPECT_THAT(implausible(space, 3), HasSubstr("ranges"));
  space.states = {1, 3};
  EXPECT_THAT(implausible(space, 3), HasSubstr("state"));
  space.states = {1, 2};
  EXPECT_THAT(implausible(space, 3), IsEmpty());
  space.ranges[1] = std::numeric_limits<float>::infinity();
  EXPECT_THAT(implausible(space, 3), HasSubstr("range"));
  space.states[1] = 0;
  EXPECT_THAT(implausible(space, 3), IsEmpty());
}

TEST(Implausible, AStampIsATime) {
  msgs::BallArray balls{kOfRobot3, {}};
  balls.header.stamp.nanosec = 1'000'000'000;
  EXPECT_THAT(implausible(balls, 3), HasSubstr("stamp"));
  balls.header.stamp = {-1, 0};
  EXPECT_THAT(implausible(balls, 3), HasSubstr("stamp"));
}

}  // namespace
}  // namespace tassilo
