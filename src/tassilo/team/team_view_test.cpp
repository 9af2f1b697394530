#include "tassilo/team/team_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tassilo/base/error.h"
#include "tassilo/message/from_scene.h"

namespace tassilo {
namespace {

using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kStart = 1.7e9;  // [s]

/// A message on its way.
struct Packet {
  std::string topic, sender;
  double arrival = 0;
  std::vector<std::byte> data;
};

void hear(TeamView& view, const Packet& packet) {
  view.hear({packet.topic, packet.sender, packet.arrival, packet.data});
}

/// Robot `id` at time t, its ball straight ahead, t - kStart further away; what it sends with each image.
std::vector<Packet> packets_of(int id, double t, const std::string& sender, double clock_ahead = 0,
                               std::uint64_t sent = 0) {
  const MessageContext context{.robot = id, .team = Team::cyan};
  const ros::Time stamp = ros_time(t + clock_ahead);
  Scene scene;
  scene.pose.emplace();
  scene.pose->x = t - kStart;
  scene.pose->covariance = {.01, 0, 0, 0, .01, 0, 0, 0, .01};
  scene.pose->kind = PoseKind::two_lines;
  scene.balls.emplace_back();
  scene.balls.back().floor.emplace();
  scene.balls.back().floor->position.mean = {1 + (t - kStart), 0};
  msgs::TeamState state = team_state_message(scene, stamp, context);
  state.role = "striker";
  state.messages = sent + 2;
  return {{ros_topic_name(kPoseTopic, id), sender, t, encoded(pose_message(*scene.pose, stamp))},
          {ros_topic_name(kBallsTopic, id), sender, t, encoded(balls_message(scene, stamp, context))},
          {ros_topic_name(kTeamStateTopic, id), sender, t, encoded(state)}};
}

const TeamMember* member_of(const TeamPicture& picture, int id) {
  const auto found = std::ranges::find(picture.members, id, &TeamMember::id);
  return found == picture.members.end() ? nullptr : &*found;
}

bool was_told(const TeamView& view, const std::string& what) {
  return std::ranges::any_of(view.news(),
                             [&](const TeamNews& news) { return news.text.find(what) != std::string::npos; });
}

TEST(TeamView, KnowsWhatItHeard) {
  TeamView view;
  for (int i = 0; i < 30; ++i)
    for (const Packet& packet : packets_of(3, kStart + i / 30., "a", 0, static_cast<std::uint64_t>(3 * i)))
      hear(view, packet);
  const TeamPicture picture = view.picture(kStart + 1);
  ASSERT_EQ(picture.members.size(), 1U);
  const TeamMember& member = picture.members[0];
  EXPECT_EQ(member.id, 3);
  EXPECT_EQ(member.team, Team::cyan);
  EXPECT_EQ(member.presence, Presence::here);
  EXPECT_EQ(member.role, "striker");
  ASSERT_TRUE(member.scene.pose);
  EXPECT_NEAR(member.scene.pose->x, 29 / 30., 1e-6);
  EXPECT_EQ(member.scene.pose->kind, PoseKind::two_lines);
  ASSERT_EQ(member.scene.balls.size(), 1U);
  EXPECT_NEAR(member.scene.t, kStart + 29 / 30., 1e-6);
  EXPECT_EQ(member.loss, 0);
  EXPECT_THAT(member.troubles, IsEmpty());
  EXPECT_EQ(picture.counts.heard, 90);
  EXPECT_EQ(picture.counts.refused + picture.counts.late + picture.counts.repeated, 0);
  EXPECT_TRUE(was_told(view, "appeared"));
}

/// A link that loses, repeats, holds back and falls silent.
struct Link {
  double loss = 0, repeat = 0, hold = 0;  ///< Probabilities.
  double silence_from = 1e9, silence_to = 1e9;
};

std::vector<Packet> over(const Link& link, std::vector<Packet> packets, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> chance(0, 1);
  std::vector<Packet> arrived;
  for (Packet& packet : packets) {
    packet.arrival += 0.005;
    if (chance(random) < link.loss) continue;
    if (packet.arrival > kStart + link.silence_from && packet.arrival < kStart + link.silence_to) continue;
    if (chance(random) < link.hold) packet.arrival += 0.5 * chance(random);
    arrived.push_back(packet);
    if (chance(random) < link.repeat) {
      packet.arrival += 0.1 * chance(random);
      arrived.push_back(packet);
    }
  }
  std::ranges::stable_sort(arrived, {}, &Packet::arrival);
  return arrived;
}

class OverABadLink : public testing::TestWithParam<Link> {};

TEST_P(OverABadLink, TheNewestThatCameIsKnownAndEachIsCounted) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::vector<Packet> sent;
    std::uint64_t count = 0;
    for (int i = 0; i < 300; ++i)
      for (Packet& packet : packets_of(3, kStart + i / 30., "a", 0, 3 * static_cast<std::uint64_t>(i))) {
        sent.push_back(std::move(packet));
        ++count;
      }
    const std::vector<Packet> arrived = over(GetParam(), sent, seed);
    TeamView view;
    double newest = 0, end = kStart + 10;
    for (const Packet& packet : arrived) {
      hear(view, packet);
      if (packet.topic == "/robot3/pose")
        newest = std::max(newest, decoded<ros::PoseWithCovarianceStamped>(packet.data)->pose.pose.position.x);
      end = std::max(end, packet.arrival);
    }
    const TeamPicture picture = view.picture(end);
    const TeamMember* const member = member_of(picture, 3);
    ASSERT_NE(member, nullptr);
    ASSERT_TRUE(member->scene.pose);
    EXPECT_DOUBLE_EQ(member->scene.pose->x, newest);
    EXPECT_EQ(picture.counts.heard, static_cast<std::int64_t>(arrived.size()));
    EXPECT_EQ(picture.counts.refused, 0);
    const Link& link = GetParam();
    if (link.repeat == 0 && link.hold == 0) {
      EXPECT_EQ(picture.counts.late + picture.counts.repeated, 0);
    }
    if (link.silence_from > 1e6) {
      ASSERT_TRUE(member->loss);
      // Of some 450 messages in the last 5 s.
      EXPECT_NEAR(*member->loss, link.loss, 0.1) << seed;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Links, OverABadLink,
                         testing::Values(Link{}, Link{.loss = .3}, Link{.loss = .6}, Link{.repeat = .5},
                                         Link{.hold = .3}, Link{.loss = .3, .repeat = .3, .hold = .3},
                                         Link{.silence_from = 3, .silence_to = 7}));

TEST(TeamView, SilenceIsToldAndOver) {
  TeamView view;
  for (const Packet& packet : packets_of(3, kStart, "a")) hear(view, packet);
  EXPECT_EQ(view.picture(kStart + .5).members[0].presence, Presence::here);
  EXPECT_EQ(view.picture(kStart + 2).members[0].presence, Presence::stale);
  EXPECT_THAT(view.picture(kStart + 2).members[0].scene.balls, IsEmpty());  // nobody knows where it is now
  EXPECT_TRUE(view.picture(kStart + 2).members[0].scene.pose);
  EXPECT_EQ(view.picture(kStart + 6).members[0].presence, Presence::gone);
  EXPECT_TRUE(was_told(view, "is gone"));
  for (const Packet& packet : packets_of(3, kStart + 7, "a")) hear(view, packet);
  EXPECT_EQ(view.picture(kStart + 7).members[0].presence, Presence::here);
  EXPECT_TRUE(was_told(view, "is back"));
  EXPECT_THAT(view.picture(kStart + 70).members, IsEmpty());
}

TEST(TeamView, TwoWithOneNumberAreToldAndTheFirstIsBelieved) {
  TeamView view;
  for (int i = 0; i < 30; ++i) {
    const double t = kStart + i / 30.;
    for (const Packet& packet : packets_of(3, t, "a")) hear(view, packet);
    for (const Packet& packet : packets_of(3, t + 1000, "b", -1000))
      hear(view, {packet.topic, packet.sender, t, packet.data});
  }
  TeamPicture picture = view.picture(kStart + 1);
  EXPECT_NEAR(picture.members[0].scene.pose->x, 29 / 30., 1e-6);
  EXPECT_THAT(picture.members[0].troubles, Contains(HasSubstr("two senders")));
  EXPECT_EQ(picture.counts.refused, 90);
  EXPECT_EQ(std::ranges::count_if(view.news(),
                                  [](const TeamNews& n) { return n.text.find("two senders") != std::string::npos; }),
            1);
  // The first one falls silent: the second has the number from then on.
  for (const Packet& packet : packets_of(3, kStart + 3, "b")) hear(view, packet);
  picture = view.picture(kStart + 3);
  EXPECT_NEAR(picture.members[0].scene.pose->x, 3, 1e-6);
  EXPECT_TRUE(was_told(view, "started again"));
  EXPECT_THAT(view.picture(kStart + 7).members[0].troubles, IsEmpty());
}

TEST(TeamView, ARestartWithAnotherClockGoesOn) {
  TeamView view;
  for (int i = 0; i < 30; ++i)
    for (const Packet& packet : packets_of(3, kStart + i / 30., "a")) hear(view, packet);
  for (int i = 0; i < 30; ++i)
    for (const Packet& packet : packets_of(3, kStart + 3 + i / 30., "b", -86400)) hear(view, packet);
  const TeamPicture picture = view.picture(kStart + 4);
  const TeamMember& member = picture.members[0];
  EXPECT_NEAR(member.scene.pose->x, 3 + 29 / 30., 1e-6);
  EXPECT_NEAR(*member.clock_ahead, -86400, 1);
  EXPECT_NEAR(member.scene.t, kStart + 4, 0.1);  // on our clock
  EXPECT_THAT(member.troubles, Contains(HasSubstr("clock is 86400.0 s behind")));
  EXPECT_EQ(picture.counts.refused, 0);
}

TEST(TeamView, AClockTenMinutesOffIsTold) {
  TeamView view;
  for (const Packet& packet : packets_of(3, kStart, "a", 600)) hear(view, packet);
  const TeamMember member = view.picture(kStart).members[0];
  EXPECT_NEAR(*member.clock_ahead, 600, 0.1);
  EXPECT_THAT(member.troubles, Contains(HasSubstr("clock is 600.0 s ahead")));
  EXPECT_TRUE(was_told(view, "600.0 s ahead"));
}

class AClockThatWasSet : public testing::TestWithParam<double> {};

TEST_P(AClockThatWasSet, IsFollowedWithinASecond) {
  TeamView view;
  for (int i = 0; i < 60; ++i)
    for (const Packet& packet : packets_of(3, kStart + i / 30., "a")) hear(view, packet);
  for (int i = 60; i < 105; ++i)
    for (const Packet& packet : packets_of(3, kStart + i / 30., "a", GetParam())) hear(view, packet);
  const TeamPicture picture = view.picture(kStart + 3.5);
  const TeamMember& member = picture.members[0];
  EXPECT_NEAR(member.scene.pose->x, 104 / 30., 1e-6) << "what it says now is known";
  EXPECT_NEAR(*member.clock_ahead, GetParam(), 0.1);
  EXPECT_EQ(member.presence, Presence::here);
  EXPECT_TRUE(was_told(view, "its clock was set"));
}
INSTANTIATE_TEST_SUITE_P(By, AClockThatWasSet, testing::Values(-3600., -9.01, -5.01, -1.51, 1.51, 5.01, 3600.));

TEST(TeamView, WhatIsLateOrRepeatedIsNoSignOfLife) {
  TeamView view;
  std::vector<Packet> old;
  for (int i = 0; i < 5; ++i)
    for (Packet& packet : packets_of(3, kStart + i / 30., "a")) {
      hear(view, packet);
      old.push_back(std::move(packet));
    }
  for (int round = 0; round < 4; ++round)
    for (Packet& packet : old) {
      packet.arrival = kStart + 1 + 0.5 * round;
      hear(view, packet);
    }
  EXPECT_EQ(view.picture(kStart + 2.6).members[0].presence, Presence::stale);
}

TEST(TeamView, TellsOfWhichImageAMessageIsUnlessItIsRefusedOrRepeated) {
  TeamView view;
  const auto judged = [&](const Packet& packet) {
    return view.hear({packet.topic, packet.sender, packet.arrival, packet.data});
  };
  constexpr double ahead = 600;
  std::vector<std::vector<Packet>> images;
  for (int i = 0; i < 3; ++i) images.push_back(packets_of(3, kStart + 0.1 * i, "a", ahead));
  const auto first = judged(images[0][0]), newest = judged(images[2][0]);
  ASSERT_TRUE(first && newest);
  EXPECT_EQ(first->robot, 3);
  EXPECT_NEAR(first->t, kStart, 1e-3) << "on our clock";
  EXPECT_NEAR(1e-9 * static_cast<double>(newest->stamp - first->stamp), 0.2, 1e-6);
  images[1][0].arrival = kStart + 0.5;
  const auto late = judged(images[1][0]);
  ASSERT_TRUE(late);
  EXPECT_NEAR(late->t, kStart + 0.1, 1e-3);
  const auto of_the_same = judged(images[2][1]);
  ASSERT_TRUE(of_the_same);
  EXPECT_EQ(of_the_same->stamp, newest->stamp);
  EXPECT_FALSE(judged(images[1][0])) << "repeated";
  images[2][2].sender = "b";
  EXPECT_FALSE(judged(images[2][2])) << "of another sender";
  images[2][2].data.resize(20);
  EXPECT_FALSE(judged(images[2][2])) << "no message";
}

TEST(TeamView, AStateTellsMoreOfEachPose) {
  TeamView view;
  const std::vector<Packet> first = packets_of(3, kStart, "a");
  for (const Packet& packet : first) hear(view, packet);
  for (int i = 1; i < 5; ++i) hear(view, packets_of(3, kStart + i / 30., "a")[0]);  // poses without states
  EXPECT_EQ(view.picture(kStart + .2).members[0].scene.pose->kind, PoseKind::two_lines);
}

TEST(TeamView, GarbageIsCountedToldAndHarmsNobody) {
  std::mt19937 random(5);
  TeamView view;
  for (int i = 0; i < 300; ++i) {
    const double t = kStart + i / 30.;
    std::vector<Packet> packets = packets_of(3, t, "a");
    for (const Packet& packet : packets) hear(view, packet);
    // Another robot's number, and this one's, too.
    for (Packet& packet : packets_of(i % 2 == 0 ? 4 : 3, t, "garbage")) {
      for (std::byte& byte : packet.data)
        if (random() % 4 == 0) byte = static_cast<std::byte>(random());
      packet.data.resize(random() % packet.data.size());
      hear(view, packet);
    }
  }
  const TeamPicture picture = view.picture(kStart + 10);
  const TeamMember* const member = member_of(picture, 3);
  ASSERT_NE(member, nullptr);
  EXPECT_NEAR(member->scene.pose->x, 299 / 30., 1e-6);
  EXPECT_EQ(picture.counts.heard, 1800);
  EXPECT_EQ(picture.counts.refused, 900);
  ASSERT_NE(member_of(picture, 4), nullptr);
  EXPECT_THAT(member_of(picture, 4)->troubles, Contains(HasSubstr("cannot be believed")));
  EXPECT_TRUE(was_told(view, "cannot be believed"));
  EXPECT_LE(view.news().size(), 10U);  // not one a message
}

TEST(TeamView, StrangersAreRefused) {
  TeamView view({.known_robots = {1, 2}});
  for (const Packet& packet : packets_of(3, kStart, "a")) hear(view, packet);
  hear(view, {"/cmd_vel", "a", kStart, {}});
  const TeamPicture picture = view.picture(kStart);
  EXPECT_THAT(picture.members, IsEmpty());
  EXPECT_EQ(picture.counts.refused, 4);
  EXPECT_THAT(picture.troubles, Contains(HasSubstr("unknown")));
}

TEST(TeamView, TenRobotsComeAndGo) {
  TeamView view;
  std::mt19937 random(11);
  for (int i = 0; i < 2700; ++i) {
    const double t = kStart + i / 30.;
    for (int id = 1; id <= 10; ++id)
      if ((i / 300 + id) % 3 != 0)
        for (const Packet& packet : packets_of(id, t, std::to_string(id) + "/" + std::to_string((i / 300 + id) / 3)))
          hear(view, packet);
    if (i % 30 == 0) view.picture(t);
  }
  const TeamPicture picture = view.picture(kStart + 90);
  EXPECT_EQ(picture.members.size(), 10U);
  EXPECT_EQ(picture.counts.refused, 0);
  EXPECT_LE(view.news().size(), TeamView::kNews);
}

TEST(TeamViewOptions, RefuseWhatIsOutOfRange) {
  EXPECT_THROW(TeamView({.stale_s = 0}), Error);
  EXPECT_THROW(TeamView({.gone_s = .5}), Error);
  EXPECT_THROW(TeamView({.known_robots = {256}}), Error);
}

TEST(RateMeter, IsTheRate) {
  RateMeter meter;
  for (int i = 0; i < 300; ++i) meter.add(kStart + i * 0.01, 5);
  EXPECT_NEAR(meter.per_second(kStart + 3), 500, 1);
  EXPECT_EQ(meter.per_second(kStart + 6), 0);
}

}  // namespace
}  // namespace tassilo
