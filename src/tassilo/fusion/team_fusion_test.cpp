#include "tassilo/fusion/team_fusion.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {
namespace {

PoseSeen pose_at(double x, double y, double theta, double sigma_xy = 0.05, double sigma_theta = 0.03) {
  PoseSeen pose;
  pose.x = x;
  pose.y = y;
  pose.theta = theta;
  pose.covariance[0] = pose.covariance[4] = sigma_xy * sigma_xy;
  pose.covariance[8] = sigma_theta * sigma_theta;
  pose.kind = PoseKind::model;
  return pose;
}
FloorPoint in_robot(const PoseSeen& pose, FieldPoint p) {
  return inverse(make_pose2<FieldFrame, RobotFrame>(pose.x, pose.y, pose.theta)) * p;
}
Ball ball_at(const PoseSeen& pose, FieldPoint p, double sigma = 0.02) {
  Ball ball;
  ball.confidence = 0.9;
  ball.floor = BallOnFloor{{in_robot(pose, p), sigma * sigma * Eigen::Matrix2d::Identity()}, {}};
  return ball;
}
RobotSeen robot_at(const PoseSeen& pose, FieldPoint p, Team team = Team::unknown, double sigma = 0.03) {
  RobotSeen robot;
  robot.team = team;
  const FloorPoint center = in_robot(pose, p);
  robot.floor = RobotOnFloor{{center, sigma * sigma * Eigen::Matrix2d::Identity()}, {}, center, 0.45};
  return robot;
}
TeamObservation observation_of(int robot, double t, const PoseSeen& pose) {
  TeamObservation observation;
  observation.robot = robot;
  observation.t = t;
  observation.stamp = static_cast<std::int64_t>(std::llround(t * 1e9));
  observation.pose = pose;
  return observation;
}

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }
void append(std::vector<std::uint64_t>& all, const TeamThing& thing) {
  all.push_back(static_cast<std::uint64_t>(thing.id));
  for (const double value : {thing.position.mean.x, thing.position.mean.y, thing.vx, thing.vy, thing.age})
    all.push_back(bits(value));
  for (const double value : thing.covariance.reshaped()) all.push_back(bits(value));
  for (const int robot : thing.robots) all.push_back(static_cast<std::uint64_t>(robot));
}
std::vector<std::uint64_t> bits_of(const TeamWorld& world) {
  std::vector<std::uint64_t> all;
  if (world.ball) append(all, *world.ball);
  for (const TeamBall& ball : world.other_balls) append(all, ball);
  for (const TeamOpponent& one : world.opponents) append(all, one);
  return all;
}

/// Three robots for most of a second: a rolling ball, false balls, opponents and teammates among the robots.
std::vector<TeamObservation> some_play(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<TeamObservation> all;
  for (int k = 0; k < 27; ++k)
    for (int robot = 1; robot <= 3; ++robot) {
      const double t = k / 30.0 + (robot == 3 ? 0 : 0.002 * robot);
      const PoseSeen pose = pose_at(-2 + robot + 0.02 * normal(random), robot - 2, 0.3 * robot + 0.01 * normal(random));
      TeamObservation one = observation_of(robot, t, pose);
      const auto noisy = [&](double x, double y) {
        return FieldPoint{x + 0.03 * normal(random), y + 0.03 * normal(random)};
      };
      if (robot != 2 || k % 3 != 0) one.balls.push_back(ball_at(pose, noisy(1 + t, 0.5)));
      if (k % 5 == robot) one.balls.push_back(ball_at(pose, noisy(normal(random), -1)));
      one.robots.push_back(robot_at(pose, noisy(2, -0.5 + t), Team::magenta));
      one.robots.push_back(robot_at(pose, noisy(3, 1)));
      one.robots.push_back(robot_at(pose, noisy(-2 + (robot % 3 + 1), (robot % 3 + 1) - 2)));
      all.push_back(one);
    }
  return all;
}

TEST(TeamFusion, AnyOrderOfArrivalGivesTheSameBits) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<TeamObservation> play = some_play(seed);
    TeamFusion in_order;
    for (const TeamObservation& one : play) in_order.add(one, 0.95);
    const auto expected = bits_of(in_order.at(0.95));
    ASSERT_TRUE(in_order.at(0.95).ball);
    ASSERT_GE(in_order.at(0.95).opponents.size(), 2u);

    std::mt19937 random(seed);
    std::vector<TeamObservation> shuffled = play;
    std::ranges::shuffle(shuffled, random);
    TeamFusion any_order;
    for (std::size_t i = 0; i < shuffled.size(); ++i) {
      EXPECT_EQ(any_order.add(shuffled[i], 0.95), Contribution::taken);
      if (random() % 3 == 0) any_order.at(0.02 * static_cast<double>(random() % 50));  // asking changes nothing
      if (random() % 4 == 0) {
        EXPECT_EQ(any_order.add(shuffled[random() % (i + 1)], 0.95), Contribution::duplicate);
      }
    }
    EXPECT_EQ(bits_of(any_order.at(0.95)), expected);
    EXPECT_GT(any_order.counts().out_of_order, 0);
  }
}

// Both teams of a training match tell one bench: nobody's pose error is forgotten for the others' sake.
TEST(TeamFusion, TenRobotsAreAllRememberedAndNoSurerThanTheirPoses) {
  double squared = 0;
  constexpr int seeds = 40, robots = 10;
  const FieldPoint where{0.3, -0.2};
  for (unsigned seed = 0; seed < seeds; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<PoseSeen> true_poses, believed;
    for (int r = 0; r < robots; ++r) {
      const double angle = 0.628 * r;
      true_poses.push_back(pose_at(3 * std::cos(angle), 1.6 * std::sin(angle), angle + 3));
      believed.push_back(true_poses.back());
      believed.back().x += 0.05 * normal(random);
      believed.back().y += 0.05 * normal(random);
      believed.back().theta += 0.03 * normal(random);
    }
    TeamFusion fusion;
    for (int k = 0; k < 90; ++k)
      for (int r = 0; r < robots; ++r) {
        const auto i = static_cast<std::size_t>(r);
        TeamObservation one = observation_of(r + 1, k / 30. + 0.001 * r, believed[i]);
        const FieldPoint seen{where.x + 0.03 * normal(random), where.y + 0.03 * normal(random)};
        one.balls.push_back(ball_at(true_poses[i], seen, 0.03));
        fusion.add(one, one.t);
      }
    const TeamWorld world = fusion.at(3);
    ASSERT_TRUE(world.ball);
    EXPECT_EQ(world.ball->robots.size(), std::size_t{robots});
    const FieldPoint off = world.ball->position.mean - where;
    const Eigen::Vector2d e(off.x, off.y);
    squared += e.dot(world.ball->position.covariance.inverse() * e) / seeds;
  }
  EXPECT_LT(squared, 2.7);  // 2 is exact; 3.3 when eight are remembered
}

// As time goes on the past is settled: what is told later must not depend on when that was.
TEST(TeamFusion, DelaysWithinTheHistoryChangeNothingLater) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> delay(0, 0.5);
    struct Mail {
      double arrival;
      TeamObservation observation;
    };
    std::vector<Mail> mails;
    for (int second = 0; second < 5; ++second)
      for (TeamObservation one : some_play(seed)) {
        one.t += second;
        one.stamp += second * 1'000'000'000LL;
        mails.push_back({one.t, one});
      }
    TeamFusion prompt, late;
    std::ranges::sort(mails, {}, &Mail::arrival);
    for (const Mail& mail : mails) prompt.add(mail.observation, mail.arrival), prompt.at(mail.arrival);
    for (Mail& mail : mails) mail.arrival += delay(random);
    std::ranges::sort(mails, {}, &Mail::arrival);
    for (const Mail& mail : mails) {
      late.add(mail.observation, mail.arrival);
      late.at(mail.arrival);
      EXPECT_LT(late.size(), 140u);
    }
    EXPECT_EQ(late.counts().too_late, 0);
    EXPECT_GT(late.counts().replayed, 0);
    EXPECT_EQ(bits_of(late.at(5.5)), bits_of(prompt.at(5.5)));
  }
}

TEST(TeamFusion, WhatIsOlderThanTheHistoryOrOfTheFutureIsDroppedAndCounted) {
  TeamFusion fusion;
  const PoseSeen pose = pose_at(0, 0, 0);
  EXPECT_EQ(fusion.add(observation_of(1, 10, pose), 10.1), Contribution::taken);
  EXPECT_EQ(fusion.add(observation_of(2, 9, pose), 10.1), Contribution::too_late);
  EXPECT_EQ(fusion.add(observation_of(2, 11, pose), 10.1), Contribution::refused);
  EXPECT_EQ(fusion.add(observation_of(2, std::nan(""), pose), 10.1), Contribution::refused);
  EXPECT_EQ(fusion.add(observation_of(1, 10, pose), 10.2), Contribution::duplicate);
  EXPECT_EQ(fusion.counts().taken, 1);
  EXPECT_EQ(fusion.counts().too_late, 1);
  EXPECT_EQ(fusion.counts().refused, 2);
  EXPECT_EQ(fusion.counts().duplicates, 1);
}

TEST(TeamFusion, OnlyWhatIsYoungerIsDoneAgain) {
  TeamFusion fusion;
  const PoseSeen pose = pose_at(0, 0, 0);
  for (int i = 0; i < 100; ++i) fusion.add(observation_of(1, 5 + i * 0.005, pose), 5.5), fusion.at(5 + i * 0.005);
  EXPECT_EQ(fusion.counts().replayed, 0);
  fusion.add(observation_of(2, 5.4501, pose), 5.5);
  fusion.at(5.5);
  EXPECT_EQ(fusion.counts().replayed, 9);
}

TEST(TeamFusion, OfATimeBeforeTheHistoryNothingIsKnownAnyMore) {
  TeamFusion fusion;
  const PoseSeen pose = pose_at(0, 0, 0);
  for (int i = 0; i < 300; ++i) {
    TeamObservation one = observation_of(1, i / 100.0, pose);
    one.balls.push_back(ball_at(pose, {2, 0}));
    fusion.add(one, one.t);
    fusion.at(one.t);
  }
  EXPECT_TRUE(fusion.at(2.5).ball);
  EXPECT_FALSE(fusion.at(1).ball);
  EXPECT_TRUE(fusion.at(2.99).ball);
}

TEST(TeamFusion, TheHistoryIsBoundedHoweverManySend) {
  TeamFusionOptions options;
  options.max_observations = 64;
  TeamFusion fusion(options);
  const PoseSeen pose = pose_at(0, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    TeamObservation one = observation_of(i % 40, 5 + i * 1e-4, pose);
    one.balls.push_back(ball_at(pose, {2, 0}));
    EXPECT_EQ(fusion.add(one, 5.2), Contribution::taken);
    EXPECT_LE(fusion.size(), 64u);
  }
  EXPECT_TRUE(fusion.at(5.2).ball);
}

TEST(TeamFusion, ABallThatOneRobotSeesIsAsUncertainAsItsPoseHoweverOften) {
  TeamFusion fusion;
  const PoseSeen pose = pose_at(0, 0, 0.5, 0.05, 0.04);
  double t = 0;
  for (int i = 0; i < 30; ++i) {
    t = i / 30.0;
    TeamObservation one = observation_of(1, t, pose);
    one.balls.push_back(ball_at(pose, {3, 0}));
    fusion.add(one, t);
  }
  const TeamWorld world = fusion.at(t);
  ASSERT_TRUE(world.ball);
  EXPECT_NEAR(world.ball->position.mean.x, 3, 0.02);
  EXPECT_GT(std::sqrt(world.ball->position.covariance(1, 1)), 0.85 * std::hypot(0.05, 3 * 0.04));
  EXPECT_EQ(world.ball->robots, (RecycledVector<int>{1}));
  EXPECT_EQ(world.ball->age, 0);
}

TEST(TeamFusion, ARobotThatSeesNothingGetsTheBallOfTheOthersWithItsAge) {
  TeamFusion fusion;
  const PoseSeen here = pose_at(0, 0, 0), there = pose_at(4, 1, 3);
  for (int i = 0; i < 20; ++i) {
    const double t = i / 30.0;
    TeamObservation one = observation_of(1, t, here);
    one.balls.push_back(ball_at(here, {2, 0}));
    fusion.add(one, t);
    fusion.add(observation_of(2, t, there), t);
  }
  const double last = 19 / 30.0;
  double sigma = 0;
  for (const double later : {0.0, 0.2, 0.5, 0.8}) {
    const TeamWorld world = fusion.at(last + later);
    ASSERT_TRUE(world.ball) << later;
    EXPECT_NEAR(world.ball->age, later, 1e-12);
    EXPECT_NEAR(world.ball->position.mean.x, 2, 0.05);
    EXPECT_GT(world.ball->covariance(0, 0), sigma);
    sigma = world.ball->covariance(0, 0);
  }
  EXPECT_FALSE(fusion.at(last + 2.1).ball);
}

TEST(TeamFusion, OneFalseBallIsNeverTold) {
  TeamFusion fusion;
  const PoseSeen pose = pose_at(0, 0, 0);
  for (int i = 0; i < 90; ++i) {
    const double t = i / 30.0;
    TeamObservation one = observation_of(1, t, pose);
    if (i >= 20) one.balls.push_back(ball_at(pose, {2, 0}));
    if (i % 10 == 5) one.balls.push_back(ball_at(pose, {4, 1 - i * 0.02}));
    fusion.add(one, t);
    const TeamWorld world = fusion.at(t);
    EXPECT_EQ(world.ball.has_value(), i >= 22) << i;
    EXPECT_TRUE(world.other_balls.empty());
  }
}

TEST(TeamFusion, AKickKeepsTheBallsIdentity) {
  for (const double angle : {0.0, 1.0, 2.5, -2.0}) {
    SCOPED_TRACE(angle);
    TeamFusion fusion;
    const PoseSeen pose = pose_at(0, 0, 0);
    FieldPoint ball{3, 0};
    int id = 0;
    for (int i = 0; i < 45; ++i) {
      const double t = i / 30.0;
      if (i >= 30) ball = ball + FieldPoint{4 / 30.0 * std::cos(angle), 4 / 30.0 * std::sin(angle)};
      TeamObservation one = observation_of(1, t, pose);
      one.balls.push_back(ball_at(pose, ball));
      fusion.add(one, t);
      const TeamWorld world = fusion.at(t);
      if (i < 5) continue;
      ASSERT_TRUE(world.ball);
      if (i == 5) id = world.ball->id;
      EXPECT_EQ(world.ball->id, id);
      if (i < 44) continue;
      EXPECT_NEAR(world.ball->vx, 4 * std::cos(angle), 0.5);
      EXPECT_NEAR(world.ball->vy, 4 * std::sin(angle), 0.5);
    }
  }
}

TEST(TeamFusion, TeammatesAreNoOpponents) {
  TeamFusion fusion;
  const PoseSeen first = pose_at(0, 0, 0), second = pose_at(2, 0.3, 2);
  for (int i = 0; i < 30; ++i) {
    const double t = i / 30.0;
    TeamObservation one = observation_of(1, t, first), two = observation_of(2, t, second);
    one.robots = {robot_at(first, {2.05, 0.25}), robot_at(first, {2.4, -0.2})};  // a teammate and its opponent, close
    fusion.add(two, t);
    fusion.add(one, t);
    if (i < 5) continue;
    const TeamWorld world = fusion.at(t);
    ASSERT_EQ(world.opponents.size(), 1u) << i;
    EXPECT_NEAR(world.opponents[0].position.mean.x, 2.4, 0.05);
  }
  // By color, where teammates do not tell where they are.
  TeamFusionOptions options;
  options.own_team = Team::cyan;
  TeamFusion by_color(options);
  for (int i = 0; i < 30; ++i) {
    TeamObservation one = observation_of(1, i / 30.0, first);
    one.robots = {robot_at(first, {2, 0}, Team::cyan), robot_at(first, {3, 0}, Team::magenta)};
    by_color.add(one, i / 30.0);
  }
  const TeamWorld world = by_color.at(1);
  ASSERT_EQ(world.opponents.size(), 1u);
  EXPECT_EQ(world.opponents[0].team, Team::magenta);
}

TEST(TeamFusion, PosesThatMayBeWrongAreNotUsed) {
  PoseSeen mirrored = pose_at(0, 0, 0), old = mirrored, vague = mirrored, turned = mirrored, broken = mirrored;
  mirrored.mirror = true;
  old.age = 10;
  vague.covariance[0] = 4;
  turned.covariance[8] = 1;
  broken.covariance[1] = std::nan("");
  for (const auto& pose : {std::optional(mirrored), std::optional(old), std::optional(vague), std::optional(turned),
                           std::optional(broken), std::optional<PoseSeen>()}) {
    TeamFusion fusion;
    for (int i = 0; i < 10; ++i) {
      TeamObservation one = observation_of(1, i / 30.0, pose.value_or(PoseSeen()));
      one.pose = pose;
      one.balls.push_back(ball_at(pose_at(0, 0, 0), {2, 0}));
      fusion.add(one, i / 30.0);
    }
    EXPECT_FALSE(fusion.at(0.4).ball);
    EXPECT_EQ(fusion.counts().without_pose, 10);
  }
}

bool is_finite(const TeamThing& thing) {
  return thing.covariance.allFinite() && std::isfinite(thing.position.mean.x) && std::isfinite(thing.position.mean.y) &&
         std::isfinite(thing.vx) && std::isfinite(thing.vy) && thing.covariance(0, 0) >= 0 &&
         thing.covariance(1, 1) >= 0;
}

// Numbers as nobody should send them: nothing told is ever NaN, nothing stops the program, and the ball is found again.
TEST(TeamFusion, WhateverComesWhatIsToldAreNumbers) {
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<double> odd = {0,         -0.0,         1,    -1,  1e-300, 1e300, -1e300, infinity,
                                   -infinity, std::nan(""), 1e-9, 999, 0.02};
  for (unsigned seed = 0; seed < 25; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-4, 4);
    const auto number = [&](double usual) { return random() % 8 == 0 ? odd[random() % odd.size()] : usual; };
    TeamFusion fusion;
    double now = 100;
    for (int i = 0; i < 300; ++i) {
      now += 0.02;
      PoseSeen pose = pose_at(number(place(random)), number(place(random)), number(place(random)));
      for (double& value : pose.covariance) value = number(value);
      pose.age = number(0);
      TeamObservation one =
          observation_of(static_cast<int>(random() % 12), number(now - 0.01 * (random() % 60)), pose_at(0, 0, 0));
      one.stamp = static_cast<std::int64_t>(random() % 1000);
      one.pose = pose;
      for (unsigned k = 0; k < random() % 4; ++k) {
        Ball ball = ball_at(pose_at(0, 0, 0), {number(place(random)), number(place(random))});
        ball.confidence = number(0.5);
        for (double& value : ball.floor->position.covariance.reshaped()) value = number(value);
        one.balls.push_back(ball);
        RobotSeen robot = robot_at(pose_at(0, 0, 0), {number(place(random)), number(place(random))});
        robot.floor->width = number(0.4);
        for (double& value : robot.floor->nearest.covariance.reshaped()) value = number(value);
        one.robots.push_back(robot);
      }
      fusion.add(one, number(now));
      const TeamWorld world = fusion.at(number(now));
      if (world.ball) {
        ASSERT_TRUE(is_finite(*world.ball)) << i;
      }
      for (const TeamBall& ball : world.other_balls) ASSERT_TRUE(is_finite(ball)) << i;
      for (const TeamOpponent& opponent : world.opponents) ASSERT_TRUE(is_finite(opponent)) << i;
    }
    now += 3;
    for (int i = 0; i < 30; ++i) {
      const PoseSeen pose = pose_at(0, 0, 0);
      TeamObservation one = observation_of(1, now + i / 30.0, pose);
      one.balls.push_back(ball_at(pose, {2, 1}));
      fusion.add(one, one.t);
    }
    const TeamWorld world = fusion.at(now + 1);
    ASSERT_TRUE(world.ball);
    EXPECT_NEAR(world.ball->position.mean.x, 2, 0.05);
  }
}

TEST(TeamFusion, ExactPosesAndSightingsAreNoTrouble) {
  TeamFusion fusion;
  const PoseSeen exact = pose_at(1, 0, 0, 0, 0);
  for (int i = 0; i < 200; ++i) {
    TeamObservation one = observation_of(i % 2, i / 60.0, exact);
    one.balls.push_back(ball_at(exact, {2, 0}, 0));
    one.robots.push_back(robot_at(exact, {3, 0}, Team::cyan, 0));
    fusion.add(one, i / 60.0);
    const TeamWorld world = fusion.at(i / 60.0);
    if (world.ball) {
      ASSERT_TRUE(is_finite(*world.ball));
    }
  }
  EXPECT_NEAR(fusion.at(4).ball->position.mean.x, 2, 1e-3);
}

TEST(TeamFusion, MoreRobotsThanAThingRemembersAreNoTrouble) {
  TeamFusion fusion;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 600; ++i) {
    const double t = i / 300.0;
    PoseSeen pose = pose_at(0, 0.1 * (i % 14), 0);
    TeamObservation one = observation_of(i % 14, t, pose);
    one.balls.push_back(ball_at(pose, {2 + 0.03 * normal(random), 0}));
    fusion.add(one, t);
  }
  const TeamWorld world = fusion.at(2);
  ASSERT_TRUE(world.ball);
  EXPECT_NEAR(world.ball->position.mean.x, 2, 0.05);
  EXPECT_TRUE(world.other_balls.empty());
}

TEST(TeamFusionOptions, AreChecked) {
  EXPECT_NO_THROW(TeamFusionOptions().check());
  EXPECT_THROW(TeamFusion({.pose_memory = 0}), Error);
  EXPECT_THROW(TeamFusion({.confirm_time = 1, .max_age = 0.5}), Error);
  EXPECT_THROW(TeamFusion({.history = std::nan("")}), Error);
}

}  // namespace
}  // namespace tassilo
