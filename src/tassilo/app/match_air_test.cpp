#include "tassilo/app/match_air.h"

#include <gtest/gtest.h>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

Scene scene_at(double t) {
  Scene scene;
  scene.t = t;
  PoseSeen pose;
  pose.x = 1;
  pose.y = -0.5;
  pose.theta = 2;
  pose.covariance = {.01, .004, 0, .004, .005, 0, 0, 0, .002};
  pose.kind = PoseKind::two_lines;
  pose.age = 0.25;
  scene.pose = pose;
  Ball ball;
  ball.confidence = 0.75;
  ball.floor.emplace();
  ball.floor->position.mean = {2, 0.5};
  ball.floor->position.covariance << .02, 0, 0, .01;
  scene.balls.push_back(ball);
  return scene;
}

std::shared_ptr<const TeamPacket> packet_at(double t) {
  return std::make_shared<const TeamPacket>(packet_of(3, Team::cyan, scene_at(t), Role::striker));
}

TEST(TeamPacket, SaysWhatWasSeen) {
  const auto word = word_of(*packet_at(1.5), 3);
  ASSERT_TRUE(word);
  EXPECT_EQ(word->role, Role::striker);
  EXPECT_EQ(word->observation.robot, 3);
  EXPECT_DOUBLE_EQ(word->observation.t, 1.5);
  EXPECT_EQ(word->observation.stamp, 1'500'000'000);
  ASSERT_TRUE(word->observation.pose);
  EXPECT_DOUBLE_EQ(word->observation.pose->theta, 2);
  EXPECT_EQ(word->observation.pose->kind, PoseKind::two_lines);
  EXPECT_DOUBLE_EQ(word->observation.pose->age, 0.25);
  ASSERT_EQ(word->observation.balls.size(), 1U);
  EXPECT_NEAR(word->observation.balls[0].floor->position.mean.x, 2, 1e-6);
}

TEST(TeamPacket, WithoutAPoseHasNone) {
  Scene scene = scene_at(1);
  scene.pose.reset();
  const auto word = word_of(packet_of(3, Team::cyan, scene, Role::defender), 3);
  ASSERT_TRUE(word);
  EXPECT_FALSE(word->observation.pose);
}

TEST(TeamPacket, OfAnotherRobotOrOfTwoImagesIsNotBelieved) {
  const auto one = packet_at(1), two = packet_at(1.1);
  EXPECT_FALSE(word_of(*one, 4));
  TeamPacket mixed = *one;
  mixed.balls = two->balls;
  EXPECT_FALSE(word_of(mixed, 3));
  mixed = *one;
  mixed.pose = two->pose;
  EXPECT_FALSE(word_of(mixed, 3));
}

TEST(TeamPacket, SpoiledDiffersAndIsMostlyRefused) {
  std::mt19937_64 random(1);
  const auto packet = packet_at(1);
  int refused = 0;
  constexpr int kTimes = 2000;
  for (int i = 0; i < kTimes; ++i) {
    const TeamPacket bad = spoiled(*packet, random);
    EXPECT_TRUE(bad.state != packet->state || bad.balls != packet->balls || bad.robots != packet->robots ||
                bad.pose != packet->pose);
    refused += !word_of(bad, 3);
  }
  EXPECT_GT(refused, kTimes / 2);
}

TEST(MatchAir, CarriesAllWhereNothingIsLostInTheOrderInWhichItWasTold) {
  MatchAir air({});
  for (int i = 0; i < 10; ++i) air.tell(1 + 0.1 * i, 3, 5, packet_at(1 + 0.1 * i));
  const auto heard = air.hear(2);
  ASSERT_EQ(heard.size(), 10U);
  for (std::size_t i = 1; i < heard.size(); ++i)
    EXPECT_GT(heard[i].word.observation.t, heard[i - 1].word.observation.t);
  EXPECT_EQ(heard[0].to, 5);
  EXPECT_TRUE(air.hear(3).empty());
}

TEST(MatchAir, OptionsOutOfRangeAreNamed) {
  EXPECT_THROW(MatchAir({.loss = 1.5}), Error);
  EXPECT_THROW(MatchAir({.delay_s = -1}), Error);
}

TEST(MatchAir, EveryPacketIsAccountedFor) {
  std::mt19937_64 random(2);
  MatchAir air({.loss = 0.3, .delay_s = 0.2, .seed = 7});
  constexpr int kPackets = 5000;
  std::int64_t heard = 0;
  for (int i = 0; i < kPackets; ++i) {
    const double t = 0.01 * i;
    const auto packet = packet_at(t);
    air.tell(t, 3, 1 + i % 2,
             random() % 3 == 0 ? std::make_shared<const TeamPacket>(spoiled(*packet, random)) : packet);
    for (const auto& [to, word] : air.hear(t)) {
      EXPECT_LE(word.observation.t, t);
      ++heard;
    }
    if (i == kPackets / 2) air.leave(2);
    const AirCounts& counts = air.counts();
    ASSERT_EQ(counts.told, counts.lost + counts.refused + counts.heard + static_cast<std::int64_t>(air.on_the_way()));
  }
  const AirCounts& counts = air.counts();
  EXPECT_EQ(counts.told, kPackets);
  EXPECT_EQ(counts.heard, heard);
  EXPECT_NEAR(static_cast<double>(counts.lost), 0.3 * kPackets, 0.03 * kPackets);
  EXPECT_GT(counts.refused, kPackets / 8);
  // Each takes twice the mean at most.
  heard += static_cast<std::int64_t>(air.hear(0.01 * kPackets + 0.4).size());
  EXPECT_EQ(air.on_the_way(), 0U);
  EXPECT_EQ(counts.heard, heard);
  EXPECT_EQ(counts.told, counts.lost + counts.refused + counts.heard);
}

}  // namespace
}  // namespace tassilo
