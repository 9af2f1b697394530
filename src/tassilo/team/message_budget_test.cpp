#include "tassilo/team/message_budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

constexpr double kStart = 1.7e9;

TEST(MessageBudget, KeepsEachRateOnAverage) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.005, 0.005);
  for (const double rate : {5., 10., 25., 30.}) {
    MessageBudget budget({.rates = {{"pose", rate}}});
    int said = 0;
    for (int i = 0; i < 3000; ++i) said += budget.allows(kPoseTopic, 10, kStart + i / 30. + jitter(random)) ? 1 : 0;
    EXPECT_NEAR(said, 100 * rate, 1 + 0.02 * 100 * rate) << rate;
    EXPECT_EQ(budget.withheld(), static_cast<std::uint64_t>(3000 - said));
  }
}

TEST(MessageBudget, NeverSaysMoreThanItsBytes) {
  std::mt19937 random(2);
  for (const double bytes : {5000., 50'000.}) {
    MessageBudget budget({.bytes_per_second = bytes});
    double said = 0;
    const double seconds = 20;
    for (int i = 0; i < 30 * seconds; ++i)
      for (const Topic& topic : kTopics) {
        const std::size_t size = 100 + random() % 1000;
        if (budget.allows(topic, size, kStart + i / 30.)) said += static_cast<double>(size);
      }
    EXPECT_LE(said, bytes * (seconds + 1) + 10'000 + 1100);  // the last picture is not yet paid
    EXPECT_GT(said, 0.6 * bytes * seconds);
    EXPECT_NEAR(budget.bytes_per_second(kStart + seconds), bytes, 0.4 * bytes);
  }
}

TEST(MessageBudget, PicturesLeaveRoomForMessages) {
  MessageBudget budget({.bytes_per_second = 100'000, .picture_rate = 30});
  int pictures = 0, poses = 0;
  for (int i = 0; i < 300; ++i) {
    const double now = kStart + i / 30.;
    pictures += budget.allows(kImageTopic, 40'000, now) ? 1 : 0;
    poses += budget.allows(kPoseTopic, 400, now) ? 1 : 0;
  }
  EXPECT_EQ(poses, 300);
  EXPECT_GT(pictures, 15);
  EXPECT_LT(pictures, 30);
}

TEST(MessageBudget, APictureLargerThanASecondStillComes) {
  MessageBudget budget({.bytes_per_second = 10'000});
  int pictures = 0;
  for (int i = 0; i < 3000; ++i) pictures += budget.allows(kImageTopic, 40'000, kStart + i / 30.) ? 1 : 0;
  EXPECT_GT(pictures, 15);  // one in four seconds or so
  EXPECT_LT(pictures, 35);
}

TEST(MessageBudget, ALargePictureBesideMessagesComesAndLeavesThemTheirShare) {
  for (const double bytes : {60'000., 250'000.}) {
    MessageBudget budget({.bytes_per_second = bytes});
    int pictures = 0, poses = 0;
    for (int i = 0; i < 1800; ++i) {
      const double now = kStart + i / 30.;
      for (const Topic& topic : {kPoseTopic, kBallsTopic, kTracksTopic})
        if (budget.allows(topic, 300, now)) ++poses;
      pictures += budget.allows(kImageTopic, 265'000, now) ? 1 : 0;
    }
    // All messages, or a quarter of the bytes at least.
    EXPECT_GE(poses * 300., std::min(5400 * 300., 0.95 * 0.25 * bytes * 60)) << bytes;
    EXPECT_NEAR(pictures, 60 * 0.75 * bytes / 265'000, 2) << bytes;
  }
}

TEST(MessageBudget, GoesOnWhenTheClockIsSetBack) {
  MessageBudget budget({});
  for (int i = 0; i < 30; ++i) budget.allows(kPoseTopic, 300, kStart + i / 30.);
  int said = 0;
  for (int i = 0; i < 30; ++i) said += budget.allows(kPoseTopic, 300, kStart - 3600 + i / 30.) ? 1 : 0;
  EXPECT_EQ(said, 30);
}

TEST(MessageBudget, NoBurstAfterASilence) {
  MessageBudget budget({.rates = {{"pose", 10}}});
  EXPECT_TRUE(budget.allows(kPoseTopic, 10, kStart));
  int said = 0;
  for (int i = 0; i < 30; ++i) said += budget.allows(kPoseTopic, 10, kStart + 100 + i / 30.) ? 1 : 0;
  EXPECT_LE(said, 11);
}

TEST(BudgetOptions, RefuseWhatIsOutOfRange) {
  EXPECT_THROW(MessageBudget({.bytes_per_second = 0}), Error);
  EXPECT_THROW(MessageBudget({.picture_rate = -1}), Error);
  EXPECT_THROW(MessageBudget({.rates = {{"poses", 1}}}), Error);
  EXPECT_THROW(MessageBudget({.rates = {{"pose", 0}}}), Error);
}

}  // namespace
}  // namespace tassilo
