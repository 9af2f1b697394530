#include "tassilo/message/odometry_sample.h"

#include <gtest/gtest.h>

#include <limits>

#include "tassilo/message/from_scene.h"

namespace tassilo {
namespace {

ros::Odometry message_of(const OdometrySample& sample) {
  ros::Odometry message;
  message.header = {ros_time(sample.t), "odom"};
  message.pose.pose = {{sample.x, sample.y, 0}, quaternion_of(sample.theta)};
  return message;
}

TEST(OdometrySampleFrom, GivesWhatWasTold) {
  for (const double theta : {-3.1, -1., 0., .5, 3.}) {
    const OdometrySample sample{1'700'000'000.25, -2.5, 1.25, theta};
    const ros::Odometry message = message_of(sample);
    EXPECT_EQ(unusable(message), "");
    const OdometrySample read = odometry_sample_from(message);
    EXPECT_NEAR(read.t, sample.t, 1e-6);
    EXPECT_EQ(read.x, sample.x);
    EXPECT_EQ(read.y, sample.y);
    EXPECT_NEAR(read.theta, theta, 1e-12);
  }
}

TEST(OdometrySampleFrom, WhatCannotBeIsUnusable) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const ros::Odometry good = message_of({1, 2, 3, 0});
  ros::Odometry bad = good;
  bad.header.stamp.nanosec = 1'000'000'000;
  EXPECT_EQ(unusable(bad), "its stamp is no time");
  bad = good;
  bad.header.stamp.sec = -1;
  EXPECT_EQ(unusable(bad), "its stamp is no time");
  for (const double value : {nan, 1e7, -std::numeric_limits<double>::infinity()}) {
    bad = good;
    bad.pose.pose.position.y = value;
    EXPECT_EQ(unusable(bad), "its position is out of range");
  }
  for (const double value : {nan, 0., 2.}) {
    bad = good;
    bad.pose.pose.orientation.w = value;
    EXPECT_EQ(unusable(bad), "its orientation is no rotation");
  }
  // Nobody reads velocities and covariances.
  ros::Odometry strange = good;
  strange.twist.twist.linear.x = nan;
  strange.pose.covariance[0] = -1;
  EXPECT_EQ(unusable(strange), "");
}

}  // namespace
}  // namespace tassilo
