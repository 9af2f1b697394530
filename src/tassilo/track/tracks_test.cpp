#include "tassilo/track/tracks.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {
namespace {

constexpr double kStep = 0.05;  // [s]

Ball ball_at(FloorPoint p, double sigma = 0.01, double confidence = 0.9) {
  Ball ball;
  ball.confidence = confidence;
  ball.floor = BallOnFloor{{p, sigma * sigma * Eigen::Matrix2d::Identity()}, {}};
  return ball;
}
RobotSeen robot_at(FloorPoint p, Team team = Team::unknown, double sigma = 0.02) {
  RobotSeen robot;
  robot.team = team;
  const FloorPoint nearest = p - 0.2 / std::max(norm(p), 0.2) * p;
  robot.floor = RobotOnFloor{{nearest, sigma * sigma * Eigen::Matrix2d::Identity()}, {}, p, 0.4};
  return robot;
}

/// A drive with sightings made of field positions.
struct Drive {
  double x = 0, y = 0, theta = 0;  ///< Of the robot, field frame.
  TrackState state;
  TrackOptions options;

  FloorPoint in_robot(FieldPoint p) const { return inverse(make_pose2<FieldFrame, RobotFrame>(x, y, theta)) * p; }
  /// The robot drives and turns for one step; odometry is exact.
  RobotMotion drive(double speed, double turn_rate, double dt = kStep) {
    const RobotMotion motion{speed * dt, 0, turn_rate * dt, Eigen::Matrix3d::Identity() * 1e-12};
    x += motion.x * std::cos(theta);
    y += motion.x * std::sin(theta);
    theta += motion.theta;
    return motion;
  }
  RecycledVector<TrackSeen> see(const std::vector<Ball>& balls, const std::vector<RobotSeen>& robots,
                                const RobotMotion& motion = {}, double dt = kStep) {
    state = track(state, motion, {balls, robots}, state.t + dt, options);
    return told(state, options);
  }
};

Eigen::Matrix4d covariance_of(const TrackSeen& track) {
  return Eigen::Map<const Eigen::Matrix4d>(track.covariance.data());
}

TEST(Track, WhatLiesStillHasNoVelocityHoweverTheRobotDrives) {
  const FieldPoint ball{2, 0.5}, robot{1.5, -1};
  for (const double turn_rate : {-2.0, 0.0, 0.7}) {
    SCOPED_TRACE(turn_rate);
    Drive drive;
    RecycledVector<TrackSeen> tracks;
    for (int k = 0; k < 60; ++k) {
      const RobotMotion motion = drive.drive(0.8, turn_rate);
      tracks = drive.see({ball_at(drive.in_robot(ball))}, {robot_at(drive.in_robot(robot), Team::cyan)}, motion);
    }
    ASSERT_EQ(tracks.size(), 2u);
    EXPECT_EQ(tracks[0].kind, TrackKind::ball);
    EXPECT_EQ(tracks[1].team, Team::cyan);
    for (const TrackSeen& one : tracks) {
      const FloorPoint truth = drive.in_robot(one.kind == TrackKind::ball ? ball : robot);
      EXPECT_NEAR(std::hypot(one.vx, one.vy), 0, 1e-6);
      EXPECT_NEAR(one.x, truth.x, 1e-6);
      EXPECT_NEAR(one.y, truth.y, 1e-6);
      EXPECT_EQ(one.age, 0);
    }
  }
}

TEST(Track, VelocityIsOverTheFloorInTheRobotsAxes) {
  Drive drive;
  drive.theta = 1;
  for (int k = 0; k < 100; ++k) {
    const FieldPoint ball{1 + 0.5 * k * kStep, 2};
    const RobotMotion motion = drive.drive(0.4, -0.5);
    const auto tracks = drive.see({ball_at(drive.in_robot(ball), 0.001)}, {}, motion);
    if (k < 40) continue;
    ASSERT_EQ(tracks.size(), 1u);
    EXPECT_NEAR(tracks[0].vx, 0.5 * std::cos(drive.theta), 0.01);
    EXPECT_NEAR(tracks[0].vy, -0.5 * std::sin(drive.theta), 0.01);
  }
}

// Monte Carlo over worlds that are as the filter believes: the normalized squared error is 4 in the mean.
TEST(Track, CovarianceIsWhatErrorsAre) {
  double squared = 0;
  int count = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Drive drive;
    drive.options.ball_common = 0;
    const double walk = drive.options.ball_acceleration * std::sqrt(kStep), sigma = 0.02;
    FieldPoint ball{2.5, 0.4},
        velocity{drive.options.ball_speed * normal(random), drive.options.ball_speed * normal(random)};
    for (int k = 0; k < 25; ++k) {
      // The change of velocity within a step, and what it does to the place: jointly normal.
      const auto axis = [&](double& place, double& speed) {
        const double a = walk * normal(random), b = walk * normal(random);
        place += speed * kStep + kStep * (a / 2 + b / std::sqrt(12.0));
        speed += a;
      };
      if (k > 0) {
        axis(ball.x, velocity.x);
        axis(ball.y, velocity.y);
      }
      RobotMotion motion = drive.drive(0.6, 0.8);
      motion.covariance = Eigen::Vector3d(1e-5, 1e-5, 1e-5).asDiagonal();
      motion.x += std::sqrt(1e-5) * normal(random);
      motion.y += std::sqrt(1e-5) * normal(random);
      motion.theta += std::sqrt(1e-5) * normal(random);
      FloorPoint seen = drive.in_robot(ball);
      seen = seen + FloorPoint{sigma * normal(random), sigma * normal(random)};
      const bool hidden = k % 7 == 5;
      const auto tracks = drive.see(hidden ? std::vector<Ball>{} : std::vector{ball_at(seen, sigma)}, {}, motion);
      if (k < 2) continue;
      ASSERT_EQ(tracks.size(), 1u) << "seed " << seed << ", step " << k;
      const FloorPoint at = drive.in_robot(ball);
      const double c = std::cos(drive.theta), s = std::sin(drive.theta);
      const Eigen::Vector4d error(tracks[0].x - at.x, tracks[0].y - at.y,
                                  tracks[0].vx - (c * velocity.x + s * velocity.y),
                                  tracks[0].vy - (-s * velocity.x + c * velocity.y));
      squared += error.dot(covariance_of(tracks[0]).inverse() * error);
      ++count;
    }
  }
  EXPECT_NEAR(squared / count, 4, 0.3);
}

TEST(Track, CovarianceStaysSymmetricAndPositive) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  Drive drive;
  for (int k = 0; k < 2000; ++k) {
    const RobotMotion exact = drive.drive(1, 1.3);
    const FloorPoint p{1 + 0.001 * normal(random), 0.001 * normal(random)};
    for (const TrackSeen& one : drive.see({ball_at(p, k % 2 ? 1e-4 : 1)}, {robot_at(p, Team::cyan, 1e-5)}, exact)) {
      const Eigen::Matrix4d covariance = covariance_of(one);
      EXPECT_EQ(covariance, covariance.transpose());
      EXPECT_GT(covariance.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0);
    }
  }
}

TEST(Track, KeepsIdentityWhileHiddenForHalfASecond) {
  Drive drive;
  int ball_id = 0, robot_id = 0;
  for (int k = 0; k < 60; ++k) {
    const double t = k * kStep;
    const bool hidden = k >= 20 && k < 30;
    const FloorPoint ball{1.5 + 0.6 * t, 0.5}, robot{3, -1 + 0.5 * t};
    const auto tracks = hidden ? drive.see({}, {})
                               : drive.see({ball_at(ball)}, {robot_at(robot, k < 30 ? Team::magenta : Team::unknown)});
    if (k < 3) continue;
    ASSERT_EQ(tracks.size(), 2u) << k;
    if (k == 3) ball_id = tracks[0].id, robot_id = tracks[1].id;
    EXPECT_EQ(tracks[0].id, ball_id);
    EXPECT_EQ(tracks[1].id, robot_id);
    EXPECT_EQ(tracks[1].team, Team::magenta);
    EXPECT_NEAR(tracks[0].age, hidden ? (k - 19) * kStep : 0, 1e-9);
    if (k > 10) {
      EXPECT_LT(std::hypot(tracks[0].x - ball.x, tracks[0].y - ball.y), 0.1);
    }
  }
  for (int k = 0; k < 22; ++k) drive.see({}, {});
  EXPECT_TRUE(told(drive.state, drive.options).empty());
}

TEST(Track, RobotsThatPassEachOtherKeepTheirIdentity) {
  for (const Team other : {Team::unknown, Team::cyan, Team::magenta})
    for (unsigned seed = 0; seed < 20; ++seed) {
      SCOPED_TRACE(seed);
      std::mt19937 random(seed);
      std::normal_distribution<double> noise(0, 0.03);
      Drive drive;
      int left_id = 0, right_id = 0;
      for (int k = 0; k < 60; ++k) {
        const double along = 1.5 - 1.0 * k * kStep;
        const FloorPoint a{2, along}, b{3, -along};
        const auto noisy = [&](FloorPoint p) { return p + FloorPoint{noise(random), noise(random)}; };
        const auto tracks = drive.see({}, {robot_at(noisy(a), Team::cyan), robot_at(noisy(b), other)});
        if (k < 3) continue;
        ASSERT_EQ(tracks.size(), 2u);
        const bool first_is_a = distance({tracks[0].x, tracks[0].y}, a) < distance({tracks[0].x, tracks[0].y}, b);
        const int at_a = tracks[first_is_a ? 0 : 1].id, at_b = tracks[first_is_a ? 1 : 0].id;
        if (k == 3) left_id = at_a, right_id = at_b;
        EXPECT_EQ(at_a, left_id);
        EXPECT_EQ(at_b, right_id);
      }
    }
}

TEST(Track, AKickKeepsTheBallsIdentity) {
  for (const double angle : {0.0, 1.0, 2.5, -2.0}) {
    SCOPED_TRACE(angle);
    Drive drive;
    FloorPoint ball{2, 0};
    int id = 0;
    RecycledVector<TrackSeen> tracks;
    for (int k = 0; k < 40; ++k) {
      if (k >= 20) ball = ball + FloorPoint{5 * kStep * std::cos(angle), 5 * kStep * std::sin(angle)};
      tracks = drive.see({ball_at(ball)}, {});
      ASSERT_EQ(tracks.size(), 1u);
      if (k == 0) id = tracks[0].id;
      EXPECT_EQ(tracks[0].id, id);
    }
    EXPECT_NEAR(tracks[0].vx, 5 * std::cos(angle), 0.1);
    EXPECT_NEAR(tracks[0].vy, 5 * std::sin(angle), 0.1);
  }
}

TEST(Track, ASingleFalseSightingIsNeverTold) {
  Drive drive;
  for (int k = 0; k < 100; ++k) {
    std::vector<Ball> balls{ball_at({2, 0})};
    std::vector<RobotSeen> robots;
    if (k % 10 == 5) {
      balls.push_back(ball_at({4, 1.0 - k * 0.01}, 0.02, 0.95));
      robots.push_back(robot_at({3, -1 + 0.02 * k}));
    }
    const auto tracks = drive.see(balls, robots);
    ASSERT_EQ(tracks.size(), 1u) << k;
    EXPECT_NEAR(tracks[0].x, 2, 0.01);
  }
  Drive doubtful;
  EXPECT_TRUE(doubtful.see({ball_at({2, 0}, 0.01, 0.2)}, {}).empty());
  EXPECT_EQ(Drive().see({ball_at({2, 0}, 0.01, 0.9)}, {}).size(), 1u);
}

TEST(Track, EndsWhereTheFloorShowsFree) {
  CameraModel model;
  model.width = 640;
  model.height = 480;
  model.fx = model.fy = 400;
  model.cx = 319.5;
  model.cy = 239.5;
  const MountedCamera camera(model, CameraMount{.x = 0, .y = 0, .z = 0.5, .pitch = 0.3});
  FreeSpace free{
      {0, 0}, -0.6, 0.05, RecycledVector<double>(25, 6.0), RecycledVector<SectorState>(25, SectorState::free)};
  FreeSpace blocked = free;
  blocked.ranges.assign(25, 1.5);
  for (const bool clear : {true, false}) {
    Drive drive;
    for (int k = 0; k < 10; ++k) drive.see({ball_at({2, 0})}, {robot_at({2, 0.4}, Team::cyan)});
    ASSERT_EQ(told(drive.state, drive.options).size(), 2u);
    for (int k = 0; k < 4; ++k)
      drive.state =
          track(drive.state, {}, {{}, {}, clear ? &free : &blocked, &camera}, drive.state.t + kStep, drive.options);
    EXPECT_EQ(told(drive.state, drive.options).size(), clear ? 0u : 2u);
  }
  // Too near to be in view: not seeing it means nothing.
  Drive drive;
  for (int k = 0; k < 10; ++k) drive.see({ball_at({0.35, 0})}, {});
  for (int k = 0; k < 4; ++k)
    drive.state = track(drive.state, {}, {{}, {}, &free, &camera}, drive.state.t + kStep, drive.options);
  EXPECT_EQ(told(drive.state, drive.options).size(), 1u);
}

TEST(Track, NumberOfTracksIsBounded) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-8, 8);
  Drive drive;
  for (int k = 0; k < 50; ++k) {
    std::vector<Ball> balls;
    std::vector<RobotSeen> robots;
    for (int i = 0; i < 40; ++i) balls.push_back(ball_at({place(random), place(random)}));
    for (int i = 0; i < 40; ++i) robots.push_back(robot_at({place(random), place(random)}));
    drive.see(balls, robots);
    EXPECT_LE(drive.state.tracks.size(), static_cast<std::size_t>(drive.options.max_tracks));
  }
}

TEST(Track, TheOrderOfSightingsDoesNotMatter) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.03);
  Drive a, b;
  for (int k = 0; k < 60; ++k) {
    std::vector<Ball> balls{ball_at({2 + noise(random), 0.5}), ball_at({3, -1 + noise(random)}, 0.01, 0.3)};
    std::vector<RobotSeen> robots;
    for (int i = 0; i < 5; ++i)
      robots.push_back(
          robot_at({1.5 + 0.4 * i + noise(random), 0.02 * k - 0.3 * i}, i % 2 ? Team::cyan : Team::magenta));
    const auto told_a = a.see(balls, robots);
    std::ranges::shuffle(balls, random);
    std::ranges::shuffle(robots, random);
    const auto told_b = b.see(balls, robots);
    ASSERT_EQ(told_a.size(), told_b.size());
    for (std::size_t i = 0; i < told_a.size(); ++i) {
      EXPECT_EQ(told_a[i].id, told_b[i].id);
      EXPECT_EQ(told_a[i].x, told_b[i].x);
      EXPECT_EQ(told_a[i].vy, told_b[i].vy);
    }
  }
}

// When something hides half of a robot, the middle of what shows is not its middle: it does not move for that.
TEST(Track, APartlyHiddenRobotStandsStill) {
  Drive drive;
  RecycledVector<TrackSeen> tracks;
  for (int k = 0; k < 30; ++k) {
    RobotSeen robot = robot_at({2, k < 15 ? 0.0 : 0.12}, Team::cyan);
    robot.floor->width = k < 15 ? 0.45 : 0.21;
    tracks = drive.see({}, {robot});
    if (k < 3) continue;
    ASSERT_EQ(tracks.size(), 1u) << k;
    EXPECT_EQ(tracks[0].id, 1);
    EXPECT_LT(std::abs(tracks[0].vy), 0.01);
  }
  EXPECT_NEAR(tracks[0].y, 0, 0.01);
}

// Without odometry the robot may have moved by a decimetre between frames: identities last, velocities are unknown.
TEST(Track, WithoutOdometryIdentitiesLast) {
  Drive drive;
  std::vector<int> ids;
  for (int k = 0; k < 60; ++k) {
    drive.drive(0.7, 0.3);
    const RobotMotion unknown = robot_motion(nullptr, 0, kStep, {});
    const auto tracks = drive.see({ball_at(drive.in_robot({4, 0}))}, {robot_at(drive.in_robot({4, 1.5}))}, unknown);
    if (k < 5) continue;
    ASSERT_EQ(tracks.size(), 2u);
    // The robot drives at .7 m/s and turns at .3 rad/s, which it does not know.
    for (const TrackSeen& one : tracks) EXPECT_GT(std::sqrt(one.covariance[10]), 0.7);
    if (ids.empty()) ids = {tracks[0].id, tracks[1].id};
    EXPECT_EQ((std::vector{tracks[0].id, tracks[1].id}), ids);
  }
}

TEST(Track, TimeThatDoesNotPassChangesNothing) {
  Drive drive;
  for (int k = 0; k < 5; ++k) drive.see({ball_at({2, 0})}, {});
  const TrackState same = predicted(drive.state, {}, drive.state.t, drive.options);
  ASSERT_EQ(same.tracks.size(), 1u);
  EXPECT_EQ(same.tracks[0].mean, drive.state.tracks[0].mean);
  EXPECT_EQ(same.tracks[0].covariance, drive.state.tracks[0].covariance);
}

TEST(TrackOptions, AreChecked) {
  TrackOptions options;
  EXPECT_NO_THROW(options.check());
  options.max_age = 0;
  EXPECT_THROW(options.check(), Error);
  options = {};
  options.sure_ball = 1.5;
  EXPECT_THROW(options.check(), Error);
  options = {};
  options.gate = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(options.check(), Error);
}

}  // namespace
}  // namespace tassilo
