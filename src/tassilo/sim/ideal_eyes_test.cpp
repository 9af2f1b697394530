#include "tassilo/sim/ideal_eyes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/files/field_file.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {
namespace {

FieldModel shipped(const std::string& name) {
  return read_field(std::string(TASSILO_SOURCE_DIR) + "/config/fields/" + name + ".yaml");
}
EyesOptions without_faults() {
  EyesOptions options;
  options.distance_sigma = options.bearing_sigma_deg = options.miss = options.pose_sigma = options.pose_sigma_deg = 0;
  options.lost_every_s = 1e9;
  return options;
}
/// One that looks, at (-2, 0) ahead, and another one somewhere.
World with_two(FieldPoint other) {
  World world(shipped("msl98"));
  world.add(1, Team::cyan);
  world.add(11, Team::magenta);
  world.place(1, {-2, 0}, 0);
  world.place(11, other, 0);
  return world;
}

TEST(IdealEyes, WithoutFaultsTheSceneIsTheTruthWithinTheView) {
  World world = with_two({1, 1});
  IdealEyes eyes(without_faults(), 1);
  const Scene scene = eyes.see(world);
  ASSERT_TRUE(scene.pose.has_value());
  EXPECT_EQ(scene.pose->x, -2);
  EXPECT_EQ(scene.pose->theta, 0);
  ASSERT_EQ(scene.balls.size(), 1u);
  EXPECT_NEAR(scene.balls[0].floor->position.mean.x, 2, 1e-9);
  ASSERT_EQ(scene.robots.size(), 1u);
  EXPECT_EQ(scene.robots[0].team, Team::magenta);
  EXPECT_NEAR(scene.robots[0].floor->center.x, 3, 1e-9);
  EXPECT_NEAR(scene.robots[0].floor->center.y, 1, 1e-9);
  // The blue goal is 6 m off.
  EXPECT_TRUE(scene.goals.empty());
}

TEST(IdealEyes, BehindBesideAndBeyondTheViewNothingIsSeen) {
  for (const FieldPoint ball : {FieldPoint{-3, 0}, FieldPoint{-2, 1}, FieldPoint{3.5, 0}}) {
    World world = with_two({-3, 1});
    world.place_ball(ball, 0, 0);
    IdealEyes eyes(without_faults(), 1);
    const Scene scene = eyes.see(world);
    EXPECT_TRUE(scene.balls.empty());
    EXPECT_TRUE(scene.robots.empty());
  }
}

TEST(IdealEyes, ARobotHidesWhatIsBehindIt) {
  World world = with_two({-1, 0});
  IdealEyes eyes(without_faults(), 1);
  const Scene scene = eyes.see(world);
  EXPECT_TRUE(scene.balls.empty());
  EXPECT_EQ(scene.robots.size(), 1u);
}

TEST(IdealEyes, FreeSpaceEndsAtRobotsAndWallsAndIsUnknownBehindTheBall) {
  World world = with_two({0, 1});
  const SimRobot other = world.state().robots[1];
  IdealEyes eyes(without_faults(), 1);
  const FreeSpace space = eyes.see(world).free_space.value();
  const auto field_from_robot = make_pose2<FieldFrame, RobotFrame>(-2, 0, 0);
  int at_robot = 0, at_ball = 0;
  for (std::size_t i = 0; i < space.ranges.size(); ++i) {
    const double angle = space.angle_min + static_cast<double>(i) * space.angle_increment;
    const FieldPoint end = field_from_robot * (space.ranges[i] * FloorPoint{std::cos(angle), std::sin(angle)});
    EXPECT_LE(std::abs(end.y), 2.2875 + 1e-9);
    EXPECT_LE(space.ranges[i], 5);
    if (std::abs(distance(end, other.at) - other.radius) < 1e-6) {
      ++at_robot;
      EXPECT_EQ(space.states[i], SectorState::blocked);
    }
    if (std::abs(distance(end, world.state().ball.at) - world.state().ball.radius) < 1e-6) {
      ++at_ball;
      EXPECT_EQ(space.states[i], SectorState::free);
    }
  }
  EXPECT_GT(at_robot, 5);
  EXPECT_GT(at_ball, 2);
}

TEST(IdealEyes, NoiseIsAsLargeAsTheCovarianceSays) {
  World world = with_two({1, 1});
  EyesOptions options;
  options.lost_every_s = 1e9;
  IdealEyes eyes(options, 1);
  double squared = 0, pose_squared = 0;
  int count = 0, poses = 0;
  for (int k = 0; k < 2000; ++k) {
    world.step(0.05, {});
    const Scene scene = eyes.see(world);
    if (!scene.balls.empty()) {
      const auto& [mean, covariance] = scene.balls[0].floor->position;
      const Eigen::Vector2d error(mean.x - 2, mean.y);
      // Near the truth the covariance is that of the truth, so this is 2 in the mean but for the distance's own noise.
      squared += error.dot(covariance.inverse() * error);
      ++count;
    }
    pose_squared += std::pow((scene.pose->x + 2) / options.pose_sigma, 2);
    ++poses;
    world.place_ball({0, 0}, 0, 0);
  }
  EXPECT_NEAR(count, 2000 * (1 - options.miss), 60);
  EXPECT_NEAR(squared / count, 2, 0.15);
  EXPECT_NEAR(pose_squared / poses, 1, 0.3);
}

TEST(IdealEyes, ThePoseIsLostForItsShareOfTheTime) {
  World world = with_two({1, 1});
  EyesOptions options;
  options.lost_every_s = 3;
  IdealEyes eyes(options, 1);
  int lost = 0;
  constexpr int kFrames = 8000;
  for (int k = 0; k < kFrames; ++k) {
    world.step(0.05, {});
    lost += !eyes.see(world).pose;
  }
  const double share = options.lost_s / (options.lost_s + options.lost_every_s);
  EXPECT_NEAR(1. * lost / kFrames, share, 0.25 * share);
}

TEST(IdealEyes, TheSameSeedSeesTheSame) {
  const auto balls = [](std::uint64_t seed) {
    World world = with_two({1, 1});
    EyesOptions options;
    options.seed = seed;
    IdealEyes eyes(options, 1);
    std::vector<double> seen;
    for (int k = 0; k < 20; ++k) {
      world.step(0.05, {});
      for (const Ball& ball : eyes.see(world).balls) seen.push_back(ball.floor->position.mean.x);
    }
    return seen;
  };
  EXPECT_EQ(balls(1), balls(1));
  EXPECT_NE(balls(1), balls(2));
}

TEST(IdealEyes, InTheDarkThereIsNothing) {
  World world = with_two({1, 1});
  IdealEyes eyes({}, 1);
  const Scene scene = eyes.see_black(world);
  EXPECT_FALSE(scene.pose || scene.free_space);
  EXPECT_TRUE(scene.balls.empty() && scene.robots.empty() && scene.tracks.empty() && scene.goals.empty());
}

TEST(IdealEyes, OptionsOutOfRangeAreRefused) {
  EXPECT_THROW(IdealEyes({.view_deg = 0}, 1), Error);
  EXPECT_THROW(IdealEyes({.miss = 2}, 1), Error);
  EXPECT_THROW(IdealEyes({.distance_sigma = -1}, 1), Error);
}

}  // namespace
}  // namespace tassilo
