#include "tassilo/message/to_scene.h"

#include <gtest/gtest.h>

#include <random>

#include "tassilo/message/from_scene.h"

namespace tassilo {
namespace {

Scene random_scene(unsigned seed) {
  std::mt19937 random(seed);
  const auto value = [&] { return std::uniform_real_distribution<double>(-3, 3)(random); };
  const auto point = [&] { return FloorPoint{value(), value()}; };
  const auto team = [&] { return static_cast<Team>(random() % 3); };
  const auto count = [&] { return random() % 4; };
  Scene scene;
  scene.pose.emplace();
  scene.pose->x = value();
  scene.pose->y = value();
  scene.pose->theta = value();
  for (double& c : scene.pose->covariance) c = value();
  for (auto n = count(); n > 0; --n) {
    scene.balls.emplace_back();
    scene.balls.back().confidence = value();
    scene.balls.back().floor = BallOnFloor{{point(), Eigen::Matrix2d::Random()}, {value(), value()}};
    scene.robots.emplace_back();
    scene.robots.back().team = team();
    scene.robots.back().floor =
        RobotOnFloor{{point(), Eigen::Matrix2d::Random()}, {value(), value()}, point(), value()};
    scene.goals.emplace_back();
    scene.goals.back().color = n % 2 == 0 ? GoalColor::blue : GoalColor::yellow;
    scene.goals.back().bearing = value();
    if (n % 2 == 0) scene.goals.back().position = point();
    scene.goals.back().posts.push_back({n % 2 == 0 ? PostSide::left : PostSide::right, point()});
    scene.lines.emplace_back();
    scene.lines.back().kind = n % 2 == 0 ? LineKind::boundary : LineKind::line;
    scene.lines.back().floor = {point(), point()};
    scene.lines.back().model = "halfway";
    scene.circles.push_back({point(), value()});
    TrackSeen track;
    track.id = static_cast<int>(n);
    track.kind = n % 2 == 0 ? TrackKind::ball : TrackKind::robot;
    track.team = team();
    track.x = value();
    track.vy = value();
    track.age = value();
    for (double& c : track.covariance) c = value();
    scene.tracks.push_back(track);
  }
  scene.free_space.emplace();
  scene.free_space->origin = point();
  scene.free_space->angle_min = value();
  scene.free_space->angle_increment = value();
  for (auto n = 5 * count(); n > 0; --n) {
    scene.free_space->ranges.push_back(static_cast<float>(value()));
    scene.free_space->states.push_back(static_cast<SectorState>(n % 3));
  }
  return scene;
}

/// By the bytes of all messages; a value that is lost on the way there or back makes a difference.
std::vector<std::vector<std::byte>> told(const Scene& scene) {
  const ros::Time stamp{1, 2};
  const MessageContext context{.robot = 9};
  return {encoded(pose_message(*scene.pose, stamp)),
          encoded(balls_message(scene, stamp, context)),
          encoded(goals_message(scene, stamp, context)),
          encoded(robots_message(scene, stamp, context)),
          encoded(lines_message(scene, stamp, context)),
          encoded(tracks_message(scene, stamp, context)),
          encoded(free_space_message(*scene.free_space, stamp, context))};
}

TEST(ToScene, WhatWasToldIsTheScene) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Scene scene = random_scene(seed);
    const ros::Time stamp{1, 2};
    const MessageContext context{.robot = 9};
    Scene heard;
    heard.pose = pose_from(pose_message(*scene.pose, stamp));
    EXPECT_NEAR(heard.pose->theta, scene.pose->theta, 1e-12);
    heard.pose->theta = scene.pose->theta;  // through a quaternion: not to the last bit
    heard.balls = balls_from(balls_message(scene, stamp, context));
    heard.goals = goals_from(goals_message(scene, stamp, context));
    heard.robots = robots_from(robots_message(scene, stamp, context));
    heard.lines = lines_from(lines_message(scene, stamp, context));
    heard.circles = circles_from(lines_message(scene, stamp, context));
    heard.tracks = tracks_from(tracks_message(scene, stamp, context));
    heard.free_space = free_space_from(free_space_message(*scene.free_space, stamp, context));
    EXPECT_EQ(told(heard), told(scene)) << seed;
    ASSERT_EQ(heard.balls.size(), scene.balls.size());
    for (std::size_t i = 0; i < scene.balls.size(); ++i)
      EXPECT_EQ(heard.balls[i].floor->position.mean, scene.balls[i].floor->position.mean);
  }
}

TEST(ToScene, KindsComeBack) {
  for (const PoseKind kind : {PoseKind::two_lines, PoseKind::one_line, PoseKind::predicted, PoseKind::goal,
                              PoseKind::model, PoseKind::start}) {
    Scene scene;
    scene.pose.emplace();
    scene.pose->kind = kind;
    scene.pose->age = 1.5;
    scene.pose->mirror = true;
    const msgs::TeamState state = team_state_message(scene, {}, {});
    EXPECT_EQ(pose_kind_from(state.pose_kind), kind);
    PoseSeen heard;
    add_state(heard, state);
    EXPECT_EQ(heard.kind, kind);
    EXPECT_EQ(heard.age, 1.5);
    EXPECT_TRUE(heard.mirror);
  }
  EXPECT_FALSE(pose_kind_from(team_state_message(Scene{}, {}, {}).pose_kind));
  for (const Team team : {Team::unknown, Team::cyan, Team::magenta})
    EXPECT_EQ(team_from(team_state_message(Scene{}, {}, {.team = team}).team), team);
}

}  // namespace
}  // namespace tassilo
