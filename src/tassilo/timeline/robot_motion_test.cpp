#include "tassilo/timeline/robot_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

TEST(RobotMotion, IsInTheRobotsFrameAtTheFirstTime) {
  Odometry odometry;
  odometry.add({0, 1, 1, std::numbers::pi / 2});
  odometry.add({1, 1, 3, std::numbers::pi});
  const RobotMotion motion = robot_motion(&odometry, 0, 1, {});
  EXPECT_NEAR(motion.x, 2, 1e-12);
  EXPECT_NEAR(motion.y, 0, 1e-12);
  EXPECT_NEAR(motion.theta, std::numbers::pi / 2, 1e-12);
}

TEST(RobotMotion, UncertaintyGrowsWithTheWayAndWithTime) {
  Odometry odometry;
  odometry.add({0, 0, 0, 0});
  odometry.add({1, 2, 0, 0});
  odometry.add({2, 2, 0, 0});
  const RobotMotion driven = robot_motion(&odometry, 0, 1, {}), stood = robot_motion(&odometry, 1, 2, {});
  const MotionOptions standard;
  EXPECT_NEAR(stood.covariance(0, 0), std::pow(standard.odometry_drift_sigma, 2), 1e-12);
  EXPECT_NEAR(driven.covariance(0, 0) - stood.covariance(0, 0), std::pow(2 * standard.odometry_distance_sigma, 2),
              1e-12);
}

TEST(RobotMotion, WithoutOdometryTheRobotMayBeAnywhereNear) {
  Odometry odometry;
  odometry.add({0, 0, 0, 0});
  odometry.add({1, 2, 0, 0});
  for (const RobotMotion& motion :
       {robot_motion(nullptr, 0, 0.5, {}), robot_motion(&odometry, 0.9, 1.4, {})}) {  // beyond what may be extrapolated
    EXPECT_FALSE(motion.is_measured);
    EXPECT_EQ(motion.x, 0);
    EXPECT_NEAR(motion.covariance(0, 0), std::pow(0.5 * MotionOptions{}.speed_sigma, 2), 1e-12);
  }
  EXPECT_EQ(robot_motion(nullptr, 1, 0, {}).covariance.norm(), 0) << "no time passes backwards";
}

TEST(MotionOptions, OutOfRangeAreNamed) {
  MotionOptions options;
  options.speed_sigma = 0;
  EXPECT_THROW(options.check(), Error);
}

}  // namespace
}  // namespace tassilo
