#include "tassilo/app/match_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tassilo/base/median.h"

namespace tassilo {
namespace {

TEST(Histogram, QuantilesAreThoseOfTheValuesWithinHalfABin) {
  std::mt19937 random(3);
  std::exponential_distribution<double> some(10);
  for (const int count : {1, 2, 3, 10, 1001}) {
    Histogram errors = place_errors();
    std::vector<double> values;
    for (int i = 0; i < count; ++i) {
      values.push_back(some(random));
      errors.add(values.back());
    }
    EXPECT_EQ(errors.size(), count);
    for (const double q : {0., 0.1, 0.5, 0.9, 1.}) EXPECT_NEAR(errors.quantile(q), quantile(values, q), 0.5001e-4);
  }
}

TEST(Histogram, SharesAboveCountWhatIsAbove) {
  Histogram squared(0.01);
  for (int i = 0; i < 100; ++i) squared.add(i + 0.5);
  EXPECT_DOUBLE_EQ(squared.share_above(9.21), 0.91);
  EXPECT_DOUBLE_EQ(squared.share_above(1000), 0);
  EXPECT_DOUBLE_EQ(squared.share_above(-1), 1);
}

TEST(Histogram, WhatIsNoErrorAndWhatIsHugeIsCounted) {
  Histogram errors = place_errors();
  EXPECT_EQ(errors.quantile(0.5), 0);
  errors.add(1e9);
  EXPECT_GT(errors.quantile(0.5), 1.9);
  EXPECT_TRUE(errors.is_beyond(0.5));
  errors.add(-1);
  errors.add(0);
  EXPECT_LT(errors.quantile(0.5), 1e-3);
  EXPECT_FALSE(errors.is_beyond(0.5));
  EXPECT_EQ(errors.size(), 3);
}

TEST(MatchReport, TellsOfBallsThatNobodyKnew) {
  MatchReport report;
  EXPECT_EQ(text_of(report), "nothing was seen, so there is nothing to compare\n");
  report.images = 4;
  report.blind.moments = 3;
  report.deeds = {{"search", 3}, {"defend", 1}};
  const std::string text = text_of(report);
  EXPECT_NE(text.find("robots that only hear           never"), std::string::npos) << text;
  EXPECT_NE(text.find("cyan: search 75 % defend 25 %"), std::string::npos) << text;
}

}  // namespace
}  // namespace tassilo
