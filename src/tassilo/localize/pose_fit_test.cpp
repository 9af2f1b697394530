#include "tassilo/localize/pose_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "tassilo/localize/test_world.h"

namespace tassilo {
namespace {

using test::place_error;
using test::plain_field;
using test::seen_from;
using test::turn_error;

PoseGaussian prior_at(double x, double y, double theta, double sigma_xy, double sigma_theta) {
  PoseGaussian prior{x, y, theta, Eigen::Matrix3d::Zero()};
  prior.covariance.diagonal() << sigma_xy * sigma_xy, sigma_xy * sigma_xy, sigma_theta * sigma_theta;
  return prior;
}

/// Poses all over the field, looking everywhere.
std::vector<FieldFromRobot> poses(int count, unsigned seed = 3) {
  std::mt19937 random(seed);
  const auto from = [&](double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>()(random);
  };
  std::vector<FieldFromRobot> all;
  for (int k = 0; k < count; ++k)
    all.push_back(make_pose2<FieldFrame, RobotFrame>(from(-3.5, 3.5), from(-1.8, 1.8), from(-3.14, 3.14)));
  return all;
}

TEST(FitPose, FindsThePoseFromNearby) {
  for (const bool walls : {true, false}) {
    const FieldTarget target(plain_field(walls));
    unsigned seed = 0;
    for (const FieldFromRobot& truth : poses(60)) {
      SCOPED_TRACE(++seed);
      const auto seen = seen_from(target, truth, {.goals = false, .seed = seed});
      const PoseGaussian prior = prior_at(truth.x + 0.15, truth.y - 0.1, truth.theta() + 0.1, 0.2, 0.1);
      const PoseFit fit = fit_pose(target, seen.observation(), prior);
      EXPECT_EQ(fit.lines_explained, fit.lines_seen);
      // As certain as it says: five standard deviations and no more than the prior.
      const Eigen::Vector3d off(fit.pose.x - truth.x, fit.pose.y - truth.y, wrap_angle(fit.pose.theta - truth.theta()));
      EXPECT_LT(off.dot(fit.pose.covariance.ldlt().solve(off)), 25);
      EXPECT_LE(fit.pose.covariance.trace(), prior.covariance.trace());
    }
  }
}

TEST(FitPose, CovarianceIsHonest) {
  const FieldTarget target(plain_field(true));
  double sum = 0;
  int count = 0;
  for (const FieldFromRobot& truth : poses(200, 5)) {
    const auto seen = seen_from(target, truth, {.goals = false, .seed = static_cast<unsigned>(count)});
    const PoseFit fit =
        fit_pose(target, seen.observation(), prior_at(truth.x + 0.05, truth.y, truth.theta() + 0.02, 10, 3));
    if (fit.pose.covariance(0, 0) + fit.pose.covariance(1, 1) > 0.01) continue;  // one line alone, or nothing
    const Eigen::Vector3d off(fit.pose.x - truth.x, fit.pose.y - truth.y, wrap_angle(fit.pose.theta - truth.theta()));
    sum += off.dot(fit.pose.covariance.ldlt().solve(off));
    ++count;
  }
  ASSERT_GT(count, 100);
  // Three where only a mark's own noise is there; what a line's marks share is assumed and not drawn here.
  EXPECT_LT(sum / count, 4);
  EXPECT_GT(sum / count, 0.3);
}

TEST(FitPose, KeepsThePriorWhereNothingIsSeen) {
  const FieldTarget target(plain_field(true));
  const PoseGaussian prior = prior_at(1, -0.5, 2, 0.3, 0.2);
  const PoseFit fit = fit_pose(target, {}, prior);
  EXPECT_EQ(fit.lines_seen, 0);
  EXPECT_NEAR(fit.pose.x, 1, 1e-12);
  EXPECT_NEAR(fit.pose.theta, 2, 1e-12);
  EXPECT_TRUE(fit.pose.covariance.isApprox(prior.covariance, 1e-9));
}

TEST(FitPose, OneLineTellsDistanceAndDirectionButNotWhereAlong) {
  const FieldTarget target(plain_field(true));
  const auto truth = make_pose2<FieldFrame, RobotFrame>(0.6, 1, std::numbers::pi / 2);
  auto seen = seen_from(target, truth, {.half_angle = 0.5, .range = 2, .goals = false});
  std::erase_if(seen.marks, [](const LineMark& mark) { return mark.kind != LineKind::boundary; });
  const PoseFit fit = fit_pose(target, seen.observation(), prior_at(0.8, 0.9, 1.5, 0.4, 0.2));
  EXPECT_NEAR(fit.pose.y, 1, 0.01);
  EXPECT_NEAR(fit.pose.theta, std::numbers::pi / 2, 0.01);
  EXPECT_NEAR(fit.pose.x, 0.8, 0.02);
  EXPECT_NEAR(std::sqrt(fit.pose.covariance(0, 0)), 0.4, 0.01);
}

TEST(FitPose, ALineThatIsNoneOfTheFieldsIsLeftOut) {
  const FieldTarget target(plain_field(true));
  const auto truth = make_pose2<FieldFrame, RobotFrame>(1.5, 0.3, 0.4);
  auto seen = seen_from(target, truth);
  const PoseFit clean = fit_pose(target, seen.observation(), prior_at(1.6, 0.2, 0.45, 0.2, 0.1));
  for (int k = 0; k < 20; ++k)  // the rim of a banner, say
    seen.marks.push_back({{1 + 0.05 * k, 0.4 - 0.02 * k}, {0.37, 0.93}, 0.003, 0.002, LineKind::line, 99});
  const PoseFit fit = fit_pose(target, seen.observation(), prior_at(1.6, 0.2, 0.45, 0.2, 0.1));
  EXPECT_EQ(fit.lines_explained, fit.lines_seen - 1);
  EXPECT_LT(place_error(fit.pose, clean.pose.field_from_robot()), 1e-3);
  EXPECT_LT(fit.log_likelihood, clean.log_likelihood);
}

TEST(FitPoses, HaveTheRightOneAndAreHonestWhereTheRobotTilts) {
  const FieldTarget target(plain_field(true));
  double sum = 0, sum_of_level = 0;
  int count = 0, right = 0;
  unsigned seed = 0;
  for (const FieldFromRobot& truth : poses(200, 7)) {
    SCOPED_TRACE(++seed);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const double pitch = 0.0175 * normal(random), roll = 0.0175 * normal(random);
    const auto seen =
        seen_from(target, truth, {.goals = false, .seed = seed, .eye_height = 0.3, .pitch = pitch, .roll = roll});
    if (seen.marks.empty() || seen.marks.front().line == seen.marks.back().line) continue;
    const PoseGaussian prior = prior_at(truth.x + 0.2 * normal(random), truth.y + 0.2 * normal(random),
                                        truth.theta() + 0.2 * normal(random), 0.2, 0.2);
    const auto squared_error = [&](const PoseGaussian& pose) {
      const Eigen::Vector3d off(pose.x - truth.x, pose.y - truth.y, wrap_angle(pose.theta - truth.theta()));
      return std::min(100., off.dot(pose.covariance.ldlt().solve(off)));
    };
    const auto fits = fit_poses(target, seen.observation(), prior, true);
    ASSERT_FALSE(fits.empty());
    sum += squared_error(fits.front().pose);
    sum_of_level += squared_error(fit_pose(target, seen.observation(), prior).pose);
    right += squared_error(fits.front().pose) < 20;
    ++count;
  }
  ASSERT_GT(count, 100);
  EXPECT_LT(sum / count, 8);  // 3 where marks were exact and each was of the line it seems to be
  EXPECT_GT(sum_of_level / count, 30);
  EXPECT_GT(right, 0.95 * count);
}

TEST(FitPoses, ALineThatIsNoneOfTheFieldsLeavesThePrior) {
  const FieldTarget target(plain_field(true));
  PoseObservation observation;
  std::vector<LineMark> marks;
  for (int k = 0; k < 20; ++k)  // slanting where no line of the field is
    marks.push_back({{1 + 0.05 * k, -0.4 + 0.05 * k}, {0.7, -0.7}, 0.003, 0.002, LineKind::line, 0});
  observation.marks = marks;
  const auto fits = fit_poses(target, observation, prior_at(1.5, 0.3, 0, 0.1, 0.05), true);
  ASSERT_FALSE(fits.empty());
  EXPECT_EQ(fits.front().lines_explained, 0);
  EXPECT_NEAR(fits.front().pose.x, 1.5, 1e-9);
  EXPECT_NEAR(std::sqrt(fits.front().pose.covariance(0, 0)), 0.1, 1e-9);
}

TEST(SearchPoses, HasThePoseAndItsMirrorWhereNoGoalIsSeen) {
  for (const bool walls : {true, false}) {
    const FieldTarget target(plain_field(walls));
    unsigned seed = 0;
    int found = 0, all = 0;
    for (const FieldFromRobot& truth : poses(60, 9)) {
      SCOPED_TRACE(++seed);
      const auto seen = seen_from(target, truth, {.goals = false, .seed = seed});
      const auto fits = search_poses(target, seen.observation());
      if (fits.empty()) continue;
      const auto mirror = make_pose2<FieldFrame, RobotFrame>(-truth.x, -truth.y, truth.theta() + std::numbers::pi);
      const auto has = [&](const FieldFromRobot& pose) {
        return std::ranges::any_of(fits, [&](const PoseFit& fit) {
          return place_error(fit.pose, pose) < 0.1 && turn_error(fit.pose, pose) < 0.05;
        });
      };
      ++all;
      found += has(truth) && has(mirror);
      EXPECT_EQ(has(truth), has(mirror));
    }
    EXPECT_GT(all, 40);
    EXPECT_GE(found, all - 2);
  }
}

TEST(SearchPoses, AGoalDecides) {
  const FieldTarget target(plain_field(true));
  int all = 0;
  for (const FieldFromRobot& truth : poses(200, 11)) {
    const auto seen = seen_from(target, truth);
    if (seen.goals.empty()) continue;
    const auto fits = search_poses(target, seen.observation());
    if (fits.empty()) continue;
    ++all;
    EXPECT_LT(place_error(fits.front().pose, truth), 0.1);
    EXPECT_LT(turn_error(fits.front().pose, truth), 0.05);
  }
  EXPECT_GT(all, 30);
}

TEST(SearchPoses, FindsNothingInNothing) { EXPECT_TRUE(search_poses(FieldTarget(plain_field(true)), {}).empty()); }

}  // namespace
}  // namespace tassilo
