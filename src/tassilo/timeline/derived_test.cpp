#include "tassilo/timeline/derived.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/timeline/odometry.h"
#include "tassilo/timeline/robot_motion.h"

namespace tassilo {
namespace {

// Frames that come one after the other, each asked about by several stages: one evaluation a frame, none unasked.
TEST(Derived, IsEvaluatedOncePerTimeAndOnlyWhenAsked) {
  Odometry odometry;
  for (int i = 0; i <= 40; ++i) odometry.add({0.05 * i, 0.1 * i, 0, 0});
  int evaluations = 0;
  Derived<RobotMotion> half_a_second(4, [&](double t) {
    ++evaluations;
    return robot_motion(&odometry, t - 0.5, t, {});
  });
  EXPECT_EQ(evaluations, 0);
  double before = 0.5;
  half_a_second.at(before);
  for (int frame = 1; frame <= 10; ++frame) {
    const double t = 0.5 + 0.1 * frame;
    for (int stage = 0; stage < 3; ++stage) EXPECT_NEAR(half_a_second.at(t).x, 1, 1e-9);
    half_a_second.at(before);
    EXPECT_EQ(evaluations, 1 + frame);
    before = t;
  }
}

// Of any times asked for in any order: one that is among the last `capacity` different ones is not worked out again,
// and no more than these are kept.
TEST(Derived, RemembersTheTimesWorkedOutLast) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::size_t capacity = 1 + random() % 5;
    int evaluations = 0;
    Derived<double> squares(capacity, [&](double t) {
      ++evaluations;
      return t * t;
    });
    std::vector<double> worked_out;
    for (int i = 0; i < 200; ++i) {
      const double t = static_cast<double>(random() % 8);
      const auto recent = worked_out.end() - static_cast<std::ptrdiff_t>(std::min(capacity, worked_out.size()));
      if (std::find(recent, worked_out.end(), t) == worked_out.end()) worked_out.push_back(t);
      EXPECT_EQ(squares.at(t), t * t);
      EXPECT_EQ(evaluations, static_cast<int>(worked_out.size()));
      EXPECT_LE(squares.size(), capacity);
    }
  }
}

TEST(Derived, AnswersStayWhereTheyAre) {
  Derived<double> same(3, [](double t) { return t; });
  const double& first = same.at(1);
  same.at(2);
  same.at(3);
  EXPECT_EQ(&same.at(1), &first);
  EXPECT_EQ(first, 1);
}

TEST(Derived, MayAskForOtherTimes) {
  int evaluations = 0;
  Derived<int>* counted = nullptr;
  Derived<int> seconds(3, [&](double t) {
    ++evaluations;
    return t <= 0 ? 0 : 1 + counted->at(t - 1);
  });
  counted = &seconds;
  EXPECT_EQ(seconds.at(5), 5);
  EXPECT_EQ(evaluations, 6);
  EXPECT_EQ(seconds.at(6), 6);
  EXPECT_EQ(evaluations, 7);
}

TEST(Derived, IsAskedAnewOnceCleared) {
  double learned = 1;
  Derived<double> known(2, [&](double) { return learned; });
  known.at(0);
  learned = 2;
  EXPECT_EQ(known.at(0), 1);
  known.clear();
  EXPECT_EQ(known.size(), 0u);
  EXPECT_EQ(known.at(0), 2);
}

TEST(Derived, KeepsNothingOfWhatFailed) {
  bool fails = true;
  Derived<int> once(2, [&](double) { return fails ? throw Error("here", "is nothing") : 7; });
  EXPECT_THROW(once.at(0), Error);
  EXPECT_EQ(once.size(), 0u);
  fails = false;
  EXPECT_EQ(once.at(0), 7);
}

TEST(Derived, RefusesATimeThatIsNone) {
  Derived<int> none(1, [](double) { return 0; });
  EXPECT_THAT([&] { none.at(std::numeric_limits<double>::quiet_NaN()); },
              testing::ThrowsMessage<Error>("derived: t is nan, must be finite"));
}

}  // namespace
}  // namespace tassilo
