#include "tassilo/team/clock_offset.h"

#include <gtest/gtest.h>

#include <random>

namespace tassilo {
namespace {

using Verdict = ClockOffset::Verdict;

TEST(ClockOffset, IsFoundWhateverTheDelay) {
  for (const double ahead : {0., 600., -600., 1e6}) {
    std::mt19937 random(3);
    std::exponential_distribution<double> delay(20);  // .05 s on average
    ClockOffset clock;
    EXPECT_FALSE(clock.ahead());
    for (int i = 0; i < 1000; ++i) {
      const double sent = 1e9 + 0.03 * i;
      EXPECT_EQ(clock.judge(sent + ahead, sent + 0.01 + delay(random)), Verdict::plausible);
    }
    // At least: by the quickest of the last seconds it is known to some ms.
    EXPECT_LE(*clock.ahead(), ahead - 0.01 + 1e-6);
    EXPECT_GT(*clock.ahead(), ahead - 0.02);
    EXPECT_NEAR(clock.delay(1e9 + 50 + ahead, 1e9 + 50.1), 0.1 - 0.01, 0.01);
  }
}

TEST(ClockOffset, FollowsAClockThatDrifts) {
  ClockOffset clock;
  for (int i = 0; i < 100'000; ++i) {
    const double sent = 0.1 * i;
    EXPECT_EQ(clock.judge(sent * (1 + 1e-4), sent + 0.01), Verdict::plausible);  // 1 s off after 10000 s
  }
  EXPECT_NEAR(*clock.ahead(), 1, 0.02);
}

TEST(ClockOffset, SingleStampsThatDoNotFitAreRefused) {
  ClockOffset clock;
  for (int i = 0; i < 100; ++i) {
    const double sent = 0.1 * i;
    if (i > 0 && i % 3 == 0) {
      EXPECT_EQ(clock.judge(sent + 30, sent), Verdict::from_future);
    } else if (i > 0 && i % 3 == 1) {
      EXPECT_EQ(clock.judge(sent - 30, sent), Verdict::too_old);
    } else {
      EXPECT_EQ(clock.judge(sent, sent), Verdict::plausible);
    }
  }
  EXPECT_NEAR(*clock.ahead(), 0, 1e-9);
}

TEST(ClockOffset, AClockThatWasSetIsBelievedAgain) {
  for (const double step : {-3600., 3600., 1.5}) {
    ClockOffset clock;
    for (int i = 0; i < 30; ++i) EXPECT_EQ(clock.judge(0.1 * i, 0.1 * i), Verdict::plausible);
    int refused = 0;
    Verdict verdict{};
    while ((verdict = clock.judge(3 + 0.1 * refused + step, 3 + 0.1 * refused)) != Verdict::was_set) {
      ASSERT_EQ(verdict, step > 0 ? Verdict::from_future : Verdict::too_old);
      ASSERT_LT(++refused, 20);
    }
    EXPECT_GE(refused, 9);
    EXPECT_NEAR(*clock.ahead(), step, 1e-9);
    EXPECT_EQ(clock.judge(5 + step, 5), Verdict::plausible);
  }
}

}  // namespace
}  // namespace tassilo
