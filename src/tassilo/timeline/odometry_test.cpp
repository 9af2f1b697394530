#include "tassilo/timeline/odometry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Odometry, EmptyKnowsNothing) { EXPECT_FALSE(Odometry().at(0)); }

TEST(Odometry, OneSampleAnswersOnlyAtItsOwnTime) {
  Odometry odometry;
  odometry.add({1, 2, 3, 0.5});
  EXPECT_EQ(odometry.at(1), (OdometrySample{1, 2, 3, 0.5}));
  EXPECT_FALSE(odometry.at(1.01));
  EXPECT_FALSE(odometry.at(0.99));
}

// Constant velocity is reproduced exactly, between and beyond the samples, whatever their times.
TEST(Odometry, ConstantVelocityIsReproduced) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> step(0.001, 0.05), rate(-2, 2), where(-0.099, 0.099);
    const double vx = rate(random), vy = rate(random), omega = rate(random);
    const auto truth = [&](double t) { return OdometrySample{t, vx * t, vy * t, wrap_angle(omega * t)}; };
    Odometry odometry(64);
    double first = 0, last = 0;
    std::vector<double> times;
    for (int i = 0; i < 200; ++i) {
      last += step(random);
      times.push_back(last);
      odometry.add(truth(last));
    }
    first = times[times.size() - 64];
    std::uniform_real_distribution<double> inside(first, last);
    for (int i = 0; i < 100; ++i) {
      const double offset = where(random);
      for (const double t : {inside(random), offset < 0 ? first + offset : last + offset}) {
        const auto seen = odometry.at(t);
        ASSERT_TRUE(seen) << t;
        EXPECT_NEAR(seen->x, truth(t).x, 1e-9);
        EXPECT_NEAR(seen->y, truth(t).y, 1e-9);
        EXPECT_NEAR(wrap_angle(seen->theta - truth(t).theta), 0, 1e-9);
        EXPECT_EQ(seen->t, t);
      }
    }
  }
}

TEST(Odometry, ThetaTakesTheShorterWayAndStaysWrapped) {
  Odometry odometry;
  odometry.add({0, 0, 0, kPi - 0.1});
  odometry.add({1, 0, 0, -kPi + 0.3});
  EXPECT_NEAR(odometry.at(0.25)->theta, -kPi, 1e-12);
  EXPECT_NEAR(odometry.at(0.5)->theta, -kPi + 0.1, 1e-12);
  odometry.add({2, 0, 0, 20 * kPi});
  EXPECT_NEAR(odometry.at(2)->theta, 0, 1e-12);
}

TEST(Odometry, ExtrapolatesByATenthOfASecondAndNoFurther) {
  Odometry odometry;
  odometry.add({1.0, 0, 0, 0});
  odometry.add({1.5, 1, 0, 0});
  EXPECT_TRUE(odometry.at(1.59));
  EXPECT_TRUE(odometry.at(0.91));
  EXPECT_FALSE(odometry.at(1.61));
  EXPECT_FALSE(odometry.at(0.89));
  EXPECT_FALSE(odometry.at(std::numeric_limits<double>::quiet_NaN()));
}

// A quantized step between the last two of many dense samples must not become a leap.
TEST(Odometry, ExtrapolationUsesAStretchAsLongAsItself) {
  Odometry odometry;
  for (int i = 0; i <= 100; ++i) odometry.add({i * 0.001, i == 100 ? 0.001 : 0.0, 0, 0});
  EXPECT_NEAR(odometry.at(0.15)->x, 0.002, 1e-6);
}

TEST(Odometry, KeepsTheNewestSamples) {
  Odometry odometry(3);
  for (int i = 0; i < 10; ++i) odometry.add({double(i), double(i), 0, 0});
  EXPECT_EQ(odometry.size(), 3u);
  EXPECT_FALSE(odometry.at(6));
  EXPECT_EQ(odometry.at(7)->x, 7);
  EXPECT_EQ(odometry.at(8.5)->x, 8.5);
}

TEST(Odometry, CountsWhatDoesNotComeInOrder) {
  Odometry odometry(3);
  EXPECT_EQ(odometry.add({2, 2, 0, 0}), Added::newest);
  EXPECT_EQ(odometry.add({1, 1, 0, 0}), Added::inserted);
  EXPECT_EQ(odometry.add({2, 9, 9, 9}), Added::duplicate);
  EXPECT_EQ(odometry.add({3, 3, 0, 0}), Added::newest);
  EXPECT_EQ(odometry.add({0, 0, 0, 0}), Added::too_late);
  EXPECT_EQ(odometry.add({2.5, 2.5, 0, 0}), Added::inserted);
  EXPECT_EQ(odometry.counts(), (SequenceCounts{.added = 4, .out_of_order = 2, .duplicates = 1, .too_late = 1}));
  for (const double t : {2.0, 2.25, 2.5, 3.0}) EXPECT_EQ(odometry.at(t)->x, t);
}

// Late, missing, repeated: as long as all come, the answers are those of samples in order, bit by bit.
TEST(Odometry, AnswersTheSameForAnyOrder) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> step(0.001, 0.05), walk(-0.1, 0.1), where(-0.2, 3.2);
    std::vector<OdometrySample> samples{{}};
    while (samples.back().t < 3) {
      const OdometrySample& last = samples.back();
      samples.push_back(
          {last.t + step(random), last.x + walk(random), last.y + walk(random), last.theta + walk(random)});
    }
    Odometry ordered(samples.size()), shuffled(samples.size());
    for (const OdometrySample& sample : samples) ordered.add(sample);
    std::ranges::shuffle(samples, random);
    for (const OdometrySample& sample : samples) {
      shuffled.add(sample);
      if (random() % 4 == 0) {
        EXPECT_EQ(shuffled.add(sample), Added::duplicate);
      }
    }
    for (int i = 0; i < 200; ++i) {
      const double t = where(random);
      EXPECT_EQ(ordered.at(t), shuffled.at(t)) << t;
    }
  }
}

TEST(Odometry, KnowsNothingOfTheMiddleOfALongGap) {
  Odometry odometry;
  for (int i = 0; i <= 100; ++i)
    if (i <= 20 || i >= 60) odometry.add({0.05 * i, 0.05 * i, 0, 0});  // Nothing from 1 to 3 s.
  for (int step = -20; step < 520; ++step) {
    const double t = 0.01 * step;
    const double away = std::max({-t, std::min(t - 1, 3 - t), t - 5});
    if (std::abs(away - Odometry::kMaxExtrapolation) < 1e-6) continue;
    const auto pose = odometry.at(t);
    ASSERT_EQ(pose.has_value(), away < Odometry::kMaxExtrapolation) << t;
    if (pose) {
      EXPECT_NEAR(pose->x, t, 1e-9);
    }
  }
}

TEST(Odometry, RefusesWhatIsNotFinite) {
  Odometry odometry;
  odometry.add({1, 0, 0, 0});
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const OdometrySample& wrong :
       {OdometrySample{nan, 0, 0, 0}, {2, nan, 0, 0}, {2, 0, infinity, 0}, {2, 0, 0, -infinity}, {infinity, 0, 0, 0}})
    EXPECT_THAT([&] { odometry.add(wrong); }, testing::ThrowsMessage<Error>("odometry: a value is not finite"));
  EXPECT_EQ(odometry.size(), 1u);
  EXPECT_EQ(odometry.counts(), SequenceCounts{.added = 1});
}

}  // namespace
}  // namespace tassilo
