#include "tassilo/fusion/internal/belief.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace tassilo {
namespace {

Evidence evidence_at(double x, double y, double sigma) {
  Evidence evidence;
  evidence.place = {x, y};
  evidence.noise = sigma * sigma * Eigen::Matrix2d::Identity();
  evidence.by_error << 0.05, 0, -0.08, 0, 0.05, 0.12;
  return evidence;
}

TEST(Belief, OneRobotThatSpeaksOftenIsNoMoreBelievedThanItsPose) {
  const Evidence evidence = evidence_at(1, 2, 0.02);
  const Eigen::Matrix2d by_pose = evidence.by_error * evidence.by_error.transpose();
  Belief belief = begun(evidence, 1);
  for (int i = 0; i < 1000; ++i) observe(belief, evidence, 0);  // within one moment
  EXPECT_LT((belief.covariance.topLeftCorner<2, 2>() - by_pose).norm(), 0.001 * by_pose.norm());
  // Of two robots that say the same, half of the variance is left.
  add_witness(belief);
  for (int i = 0; i < 1000; ++i) observe(belief, evidence, 1);
  EXPECT_LT((belief.covariance.topLeftCorner<2, 2>() - by_pose / 2).norm(), 0.001 * by_pose.norm());
  // In half a minute the pose has had several errors, and a thing that stands still is known better.
  Belief stands = begun(evidence, 1e-6);
  for (int i = 0; i < 900; ++i) {
    roll(stands, 1.0 / 30, {0, 1e-12, 2});
    observe(stands, evidence, 0);
  }
  EXPECT_LT(stands.covariance(0, 0), by_pose(0, 0) / 5);
  EXPECT_GT(stands.covariance(0, 0), by_pose(0, 0) / 20);
}

TEST(Belief, FitIsTheSameForAWitnessNeverMetAndOneJustAdded) {
  Belief belief = begun(evidence_at(1, 2, 0.1), 1);
  const Evidence other = evidence_at(1.1, 1.8, 0.2);
  const Fit before = fit(belief, other, -1);
  add_witness(belief);
  const Fit after = fit(belief, other, 1);
  EXPECT_NEAR(before.squared, after.squared, 1e-12);
  EXPECT_NEAR(before.minus_two_log, after.minus_two_log, 1e-12);
}

TEST(Belief, ForgettingAWitnessLeavesTheOthersAsTheyAre) {
  Belief belief = begun(evidence_at(1, 2, 0.1), 1);
  for (int witness = 1; witness < 4; ++witness) {
    add_witness(belief);
    observe(belief, evidence_at(1 + 0.1 * witness, 2, 0.1), witness);
  }
  const Belief all = belief;
  remove_witness(belief, 1);
  ASSERT_EQ(witness_count(belief), 3);
  EXPECT_EQ(belief.mean.head<7>(), all.mean.head<7>());
  EXPECT_EQ(belief.mean.segment<3>(7), all.mean.tail<3>()) << "number 3 is number 1 now";
  EXPECT_EQ(belief.mean.tail<3>(), all.mean.segment<3>(10));
  const Eigen::Matrix3d cross = belief.covariance.block<3, 3>(7, 4), cross_before = all.covariance.block<3, 3>(13, 4);
  EXPECT_EQ(cross, cross_before);
}

TEST(Belief, ABallRollsToAStopAndNotBack) {
  Belief belief = begun(evidence_at(0, 0, 0.01), 1e-6);
  belief.mean(2) = 2;
  for (int i = 0; i < 1000; ++i) roll(belief, 0.01, {0.4, 0, 2});
  EXPECT_NEAR(belief.mean(0), 2 * 2 / (2 * 0.4), 0.01);
  EXPECT_NEAR(belief.mean(2), 0, 1e-6);
  EXPECT_GE(belief.mean(2), 0);
}

TEST(Belief, CovarianceStaysSymmetricAndPositive) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  Belief belief = begun(evidence_at(0, 0, 1), 1);
  add_witness(belief);
  add_witness(belief);
  for (int i = 0; i < 5000; ++i) {
    if (i % 3 == 0) roll(belief, std::pow(10, normal(random) - 2), {0.4, i % 7 ? 0.2 : 90, 2});
    Evidence evidence = evidence_at(normal(random), normal(random), i % 2 ? 0.001 : 1);
    if (i % 5 == 0) evidence.by_error *= 1e-6;
    observe(belief, evidence, i % 3);
    ASSERT_EQ(belief.covariance, belief.covariance.transpose());
    const Eigen::MatrixXd covariance = belief.covariance;
    ASSERT_GT(covariance.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-12) << i;
  }
}

TEST(Belief, MixtureHasTheMomentsOfBoth) {
  Belief a = begun(evidence_at(0, 0, 0.1), 1), b = begun(evidence_at(1, 0, 0.2), 2);
  const Belief all = mixed(a, b, 0.25);
  EXPECT_NEAR(all.mean(0), 0.25, 1e-12);
  const double second_a = a.covariance(0, 0), second_b = b.covariance(0, 0) + 1;
  EXPECT_NEAR(all.covariance(0, 0) + 0.25 * 0.25, 0.75 * second_a + 0.25 * second_b, 1e-12);
}

}  // namespace
}  // namespace tassilo
