#include "tassilo/fusion/field_sighting.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace tassilo {
namespace {

Eigen::Matrix3d covariance_of(const PoseSeen& pose) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.covariance.data());
}

struct Draw {
  PoseSeen pose;
  Gaussian2<RobotFrame> seen;
};
Draw draw(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Draw one;
  one.pose.x = 3 * normal(random);
  one.pose.y = 2 * normal(random);
  one.pose.theta = 4 * normal(random);
  Eigen::Matrix3d a;
  for (double& value : a.reshaped()) value = 0.05 * normal(random);
  Eigen::Map<Eigen::Matrix3d>(one.pose.covariance.data()) = a * a.transpose();
  Eigen::Matrix2d b;
  for (double& value : b.reshaped()) value = 0.1 * normal(random);
  one.seen = {{2 * normal(random), 2 * normal(random)}, b * b.transpose()};
  return one;
}

TEST(OnField, DerivativeIsTheNumericOne) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    const auto [pose, seen] = draw(seed);
    const FieldSighting sighting = on_field(pose, seen);
    const double h = 1e-6;
    const auto place = [&](int number, double by) {
      PoseSeen moved = pose;
      (number == 0 ? moved.x : number == 1 ? moved.y : moved.theta) += by;
      return on_field(moved, seen).place;
    };
    for (int number = 0; number < 3; ++number) {
      const FieldPoint change = place(number, h) - place(number, -h);
      EXPECT_NEAR(sighting.by_pose(0, number), change.x / (2 * h), 1e-7);
      EXPECT_NEAR(sighting.by_pose(1, number), change.y / (2 * h), 1e-7);
    }
    // The sighting's own part: by the derivative with respect to the place in the robot's frame.
    Eigen::Matrix2d by_seen;
    for (int axis = 0; axis < 2; ++axis) {
      Gaussian2<RobotFrame> further = seen, nearer = seen;
      (axis == 0 ? further.mean.x : further.mean.y) += h;
      (axis == 0 ? nearer.mean.x : nearer.mean.y) -= h;
      const FieldPoint change = on_field(pose, further).place - on_field(pose, nearer).place;
      by_seen.col(axis) << change.x / (2 * h), change.y / (2 * h);
    }
    EXPECT_LT((sighting.own - by_seen * seen.covariance * by_seen.transpose()).norm(), 1e-8);
  }
}

// Poses and sightings drawn as their covariances say: so are the places on the field.
TEST(OnField, CovarianceIsThatOfDraws) {
  PoseSeen pose;
  pose.x = 1;
  pose.theta = 0.7;
  Eigen::Matrix3d pose_covariance;
  pose_covariance << 0.0025, 0.0005, 0.0004, 0.0005, 0.0016, -0.0003, 0.0004, -0.0003, 0.0012;
  Eigen::Map<Eigen::Matrix3d>(pose.covariance.data()) = pose_covariance;
  Gaussian2<RobotFrame> seen{{3, -1}, Eigen::Matrix2d::Identity()};
  seen.covariance << 0.01, 0.002, 0.002, 0.004;
  const Gaussian2<FieldFrame> told = gaussian(on_field(pose, seen), pose);
  const Eigen::Matrix3d root = square_root(pose_covariance);
  const Eigen::Matrix2d seen_root = seen.covariance.llt().matrixL();
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  const int count = 40000;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d error = root * Eigen::Vector3d(normal(random), normal(random), normal(random));
    const Eigen::Vector2d noise = seen_root * Eigen::Vector2d(normal(random), normal(random));
    PoseSeen moved = pose;
    moved.x += error.x();
    moved.y += error.y();
    moved.theta += error.z();
    const FieldPoint p = on_field(moved, {{seen.mean.x + noise.x(), seen.mean.y + noise.y()}, {}}).place;
    const Eigen::Vector2d off(p.x - told.mean.x, p.y - told.mean.y);
    sum += off * off.transpose();
  }
  EXPECT_LT((sum / count - told.covariance).norm(), 0.03 * told.covariance.norm());
}

TEST(SquareRoot, SquaredIsTheCovarianceWhateverItsRank) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    const Eigen::Matrix3d full = covariance_of(draw(seed).pose);
    const Eigen::Vector3d v = full.col(0).normalized() * 0.1;
    const Eigen::Vector3d w = full.col(1).normalized() * 0.02;
    for (const Eigen::Matrix3d& covariance :
         {full, Eigen::Matrix3d(v * v.transpose()), Eigen::Matrix3d(v * v.transpose() + w * w.transpose()),
          Eigen::Matrix3d(Eigen::Matrix3d::Zero()), Eigen::Matrix3d(Eigen::Vector3d(0, 1, 0).asDiagonal())}) {
      const Eigen::Matrix3d root = square_root(covariance);
      EXPECT_LT((root * root.transpose() - covariance).norm(), 1e-6 * covariance.norm() + 1e-15);
      EXPECT_GE(root.diagonal().minCoeff(), 0);
    }
  }
}

TEST(SquareRoot, OfWhatIsNoCovarianceIsFinite) {
  Eigen::Matrix3d nonsense;
  nonsense << 1, 5, -9, 5, 1, 0, -9, 0, -2;
  EXPECT_TRUE(square_root(nonsense).allFinite());
  EXPECT_TRUE(square_root(-nonsense).allFinite());
  EXPECT_TRUE(square_root(1e300 * nonsense).allFinite());
}

}  // namespace
}  // namespace tassilo
