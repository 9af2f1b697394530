#include "tassilo/app/team_bench.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tassilo/geometry/pose2.h"
#include "tassilo/message/from_scene.h"

namespace tassilo {
namespace {

using testing::ElementsAre;

constexpr double kStart = 1.7e9;  // [s]

struct Packet {
  std::string topic, sender;
  double arrival = 0;
  std::vector<std::byte> data;
};

/// What hears, and what is believed of it.
struct Ear {
  TeamView view;
  TeamBench bench;
  void hear(const Packet& packet) {
    const Heard heard{packet.topic, packet.sender, packet.arrival, packet.data};
    if (const auto believed = view.hear(heard)) bench.hear(heard, *believed);
  }
  void hear(const std::vector<Packet>& packets) {
    for (const Packet& packet : packets) hear(packet);
  }
};

/// A robot as it stands somewhere, well known to itself.
struct Eye {
  int id = 1;
  double x = 0, y = 0, theta = 0;
  Team team = Team::cyan;
  double ball_sigma = 0.05;  ///< [m]
  bool is_mirrored = false;
};
Team other(Team team) { return team == Team::cyan ? Team::magenta : Team::cyan; }

struct Seen {
  std::optional<FieldPoint> ball = {}, robot = {};
  Team marker = Team::magenta;
};

Scene scene_of(const Eye& eye, double t, const Seen& seen) {
  const auto robot_from_field = inverse(make_pose2<FieldFrame, RobotFrame>(eye.x, eye.y, eye.theta));
  Scene scene;
  scene.t = t;
  scene.pose.emplace();
  scene.pose->x = eye.x;
  scene.pose->y = eye.y;
  scene.pose->theta = eye.theta;
  scene.pose->covariance = {.0009, 0, 0, 0, .0009, 0, 0, 0, .0004};
  scene.pose->kind = PoseKind::two_lines;
  scene.pose->mirror = eye.is_mirrored;
  if (seen.ball) {
    Ball ball;
    ball.confidence = 0.9;
    ball.floor =
        BallOnFloor{{robot_from_field * *seen.ball, std::pow(eye.ball_sigma, 2) * Eigen::Matrix2d::Identity()}, {}};
    scene.balls.push_back(ball);
  }
  if (seen.robot) {
    RobotSeen robot;
    robot.team = seen.marker;
    const FloorPoint at = robot_from_field * *seen.robot;
    robot.floor = RobotOnFloor{{at, .0009 * Eigen::Matrix2d::Identity()}, {}, at, 0.45};
    scene.robots.push_back(robot);
  }
  return scene;
}

/// All that is told of an image, and comes at once: pose, balls, robots, state.
std::vector<Packet> packets_of(const Eye& eye, double t, const Seen& seen) {
  const MessageContext context{.robot = eye.id, .team = eye.team};
  const ros::Time stamp = ros_time(t);
  const Scene scene = scene_of(eye, t, seen);
  const double arrival = seconds_of(stamp);  // to the last digit: the quickest message takes no time
  const auto packet = [&](const Topic& topic, std::vector<std::byte> data) {
    return Packet{ros_topic_name(topic, eye.id), "robot " + std::to_string(eye.id), arrival, std::move(data)};
  };
  return {packet(kPoseTopic, encoded(pose_message(*scene.pose, stamp))),
          packet(kBallsTopic, encoded(balls_message(scene, stamp, context))),
          packet(kRobotsTopic, encoded(robots_message(scene, stamp, context))),
          packet(kTeamStateTopic, encoded(team_state_message(scene, stamp, context)))};
}

constexpr FieldPoint kBall{0.5, -0.3};
constexpr Eye kNear{1, -1, 0, 0.2, Team::cyan, 0.04}, kFar{2, 2.5, 1, 2.8, Team::cyan, 0.12};

/// All images of a second, in their order.
std::vector<std::vector<Packet>> play(const std::vector<Eye>& eyes, const Seen& seen, double seconds = 1) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.03);
  std::vector<std::vector<Packet>> images;
  for (int i = 0; i < 30 * seconds; ++i)
    for (const Eye& eye : eyes) {
      Seen now = seen;
      if (now.ball) now.ball = FieldPoint{now.ball->x + noise(random), now.ball->y + noise(random)};
      images.push_back(packets_of(eye, kStart + i / 30. + 0.001 * eye.id, now));
    }
  return images;
}
void hear_all(Ear& ear, const std::vector<std::vector<Packet>>& images) {
  for (const auto& image : images) ear.hear(image);
}

double largest_sigma(const TeamThing& thing) {
  return std::sqrt(thing.position.covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff());
}
std::vector<double> numbers_of(const TeamWorld& world) {
  std::vector<double> all;
  const auto add = [&](const TeamThing& thing) {
    all.insert(all.end(), {thing.position.mean.x, thing.position.mean.y, thing.vx, thing.vy, thing.age});
    for (const double value : thing.covariance.reshaped()) all.push_back(value);
    for (const int robot : thing.robots) all.push_back(robot);
  };
  if (world.ball) add(*world.ball);
  for (const TeamOpponent& one : world.opponents) add(one);
  return all;
}

TEST(TeamBench, TwoRobotsKnowTheBallAtLeastAsWellAsTheBetterOne) {
  const auto known_by = [](const std::vector<Eye>& eyes) {
    Ear ear;
    hear_all(ear, play(eyes, {.ball = kBall}));
    return ear.bench.at(kStart + 1);
  };
  const TeamWorld both = known_by({kNear, kFar});
  ASSERT_TRUE(both.ball);
  EXPECT_LT(distance(both.ball->position.mean, kBall), 0.05);
  EXPECT_THAT(both.ball->robots, ElementsAre(1, 2));
  EXPECT_LT(both.ball->age, 0.05);
  EXPECT_TRUE(both.opponents.empty());
  for (const Eye& eye : {kNear, kFar}) {
    const TeamWorld alone = known_by({eye});
    ASSERT_TRUE(alone.ball);
    EXPECT_LE(largest_sigma(*both.ball), largest_sigma(*alone.ball)) << eye.id;
  }
}

// The link holds images back, mixes up their messages and says things twice; who asks meanwhile changes nothing.
TEST(TeamBench, AnyOrderOfArrivalAndAnyRepetitionGivesTheSame) {
  const auto images = play({kNear, kFar}, {.ball = kBall, .robot = FieldPoint{1, 1}});
  Ear in_order;
  hear_all(in_order, images);
  const std::vector<double> expected = numbers_of(in_order.bench.at(kStart + 1.9));
  ASSERT_TRUE(in_order.bench.at(kStart + 1.9).ball);
  ASSERT_EQ(in_order.bench.at(kStart + 1.9).opponents.size(), 1U);
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> chance(0, 1);
    std::vector<Packet> packets;
    for (std::size_t i = 0; i < images.size(); ++i) {
      const double held = i < 2 || chance(random) < 0.5 ? 0 : 0.7 * chance(random);
      for (Packet packet : images[i]) {
        packet.arrival += i < 2 ? 0 : held + 0.09 * chance(random);
        packets.push_back(packet);
        if (chance(random) < 0.3) {
          packet.arrival += 0.5 * chance(random);
          packets.push_back(packet);
        }
      }
    }
    std::ranges::stable_sort(packets, {}, &Packet::arrival);
    Ear ear;
    for (const Packet& packet : packets) {
      ear.hear(packet);
      if (chance(random) < 0.3) ear.bench.at(packet.arrival);
    }
    EXPECT_EQ(numbers_of(ear.bench.at(kStart + 1.9)), expected) << seed;
  }
}

TEST(TeamBench, PosesAndBallsOfDifferentImagesAreNotMixed) {
  Ear ear;
  for (int i = 0; i < 30; ++i) {
    const auto here = packets_of(kNear, kStart + i / 30., {.ball = kBall});
    const auto then = packets_of(kNear, kStart + (i + 0.5) / 30, {.ball = kBall});
    ear.hear({here[0], here[3], then[1], then[2]});
    EXPECT_FALSE(ear.bench.at(kStart + (i + 0.5) / 30).ball);
  }
  EXPECT_TRUE(ear.view.picture(kStart + 1).members[0].scene.pose);
  EXPECT_FALSE(ear.view.picture(kStart + 1).members[0].scene.balls.empty());
  EXPECT_FALSE(ear.bench.at(kStart + 1).ball);
}

TEST(TeamBench, WhatIsLostOfAnImageIsNotWaitedForLong) {
  for (const std::size_t lost : {2U, 3U}) {  // robots, state
    Ear ear;
    for (auto image : play({kNear}, {.ball = kBall})) {
      image.erase(image.begin() + static_cast<std::ptrdiff_t>(lost));
      ear.hear(image);
    }
    const TeamWorld world = ear.bench.at(kStart + 1);
    ASSERT_TRUE(world.ball) << lost;
    EXPECT_LT(world.ball->age, 0.16) << lost;
  }
}

TEST(TeamBench, GarbageAndStrangersWithOnesNumberChangeNothing) {
  const auto images = play({kNear, kFar}, {.ball = kBall});
  Ear clean, spoiled;
  hear_all(clean, images);
  std::mt19937 random(3);
  for (const auto& image : images) {
    spoiled.hear(image);
    for (Packet packet : image) {
      packet.sender = "stranger";
      spoiled.hear(packet);
      packet.topic.replace(0, 7, "/robot9");
      for (std::byte& byte : packet.data)
        if (random() % 4 == 0) byte = static_cast<std::byte>(random());
      packet.data.resize(random() % packet.data.size());
      spoiled.hear(packet);
    }
  }
  EXPECT_EQ(spoiled.view.picture(kStart + 1).counts.refused, static_cast<std::int64_t>(8 * images.size()));
  EXPECT_EQ(numbers_of(spoiled.bench.at(kStart + 1)), numbers_of(clean.bench.at(kStart + 1)));
}

TEST(TeamBench, WhoIsNotSureWhichHalfItStandsInDoesNotCount) {
  Eye eye = kNear;
  eye.is_mirrored = true;
  Ear ear;
  hear_all(ear, play({eye}, {.ball = kBall}));
  EXPECT_FALSE(ear.bench.at(kStart + 1).ball);
}

TEST(TeamBench, WhoFallsSilentNoLongerCounts) {
  Ear ear;
  hear_all(ear, play({kNear, kFar}, {.ball = kBall}, 0.5));
  for (int i = 15; i < 120; ++i) ear.hear(packets_of(kNear, kStart + i / 30. + .001, {.ball = kBall}));
  const TeamWorld world = ear.bench.at(kStart + 4);
  ASSERT_TRUE(world.ball);
  EXPECT_THAT(world.ball->robots, ElementsAre(1));
  EXPECT_FALSE(ear.bench.at(kStart + 7).ball);
}

TEST(TeamBench, ARobotsClockMayShowAnything) {
  Ear ear;
  for (const auto& image : play({kNear, kFar}, {.ball = kBall}))
    for (Packet packet : image) {
      packet.arrival += packet.sender == "robot 2" ? 3600 : 3600.01;
      ear.hear(packet);
    }
  const TeamWorld world = ear.bench.at(kStart + 3601);
  ASSERT_TRUE(world.ball);
  EXPECT_THAT(world.ball->robots, ElementsAre(1, 2));
  EXPECT_LT(world.ball->age, 0.05);
}

TEST(TeamBench, OpponentsAreThoseOfAnotherColorAndOfAnyWhileBothTeamsTalk) {
  const auto opponents = [](const std::vector<Eye>& eyes, Team marker) {
    Ear ear;
    std::size_t count = 0;
    for (const auto& image : play(eyes, {.robot = FieldPoint{0, -1.5}, .marker = marker}, 2)) {
      ear.hear(image);
      count = ear.bench.at(image.back().arrival).opponents.size();
    }
    return count;
  };
  Eye theirs = kFar;
  theirs.team = other(kFar.team);
  EXPECT_EQ(opponents({kNear, kFar}, Team::magenta), 1U);
  EXPECT_EQ(opponents({kNear, kFar}, Team::cyan), 0U);
  EXPECT_EQ(opponents({kNear, theirs}, Team::magenta), 1U);
  EXPECT_EQ(opponents({kNear, theirs}, Team::cyan), 1U);
}

// A link that stood still for seconds.
TEST(TeamBench, WhatComesSecondsLateChangesNothing) {
  Ear ear;
  hear_all(ear, play({kNear}, {.ball = kBall}));
  auto late = packets_of(kFar, kStart - 2, {.ball = FieldPoint{2, 2}});
  for (Packet& packet : late) packet.arrival = kStart + 1;
  ear.hear(late);
  const TeamWorld known = ear.bench.at(kStart + 1);
  ASSERT_TRUE(known.ball);
  EXPECT_LT(distance(known.ball->position.mean, kBall), 0.05);
  EXPECT_THAT(known.ball->robots, ElementsAre(1));
  // Nor as the first thing that is ever heard.
  Ear new_ear;
  new_ear.hear(late);
  EXPECT_FALSE(new_ear.bench.at(kStart + 1).ball);
}

TEST(TeamBench, AFloodOfImagesEndsNothing) {
  Ear ear;
  for (int i = 0; i < 6000; ++i) ear.hear(packets_of(kNear, kStart + i * 1e-4, {.ball = kBall}));
  hear_all(ear, play({kFar}, {.ball = kBall}));
  EXPECT_TRUE(ear.bench.at(kStart + 1).ball);
}

}  // namespace
}  // namespace tassilo
