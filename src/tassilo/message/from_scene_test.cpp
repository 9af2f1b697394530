#include "tassilo/message/from_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tassilo {
namespace {

constexpr ros::Time kStamp{12, 34};

FreeSpace some_space() {
  FreeSpace space;
  space.origin = {0.1, -0.02};
  space.angle_min = -0.5;
  space.angle_increment = 0.25;
  for (const double range : {0., 8., 7.99, 3., 2.}) space.ranges.push_back(range);
  for (const SectorState state :
       {SectorState::unseen, SectorState::free, SectorState::free, SectorState::free, SectorState::blocked})
    space.states.push_back(state);
  return space;
}

TEST(ScanMessage, NeverClearsFloorThatNobodySaw) {
  const ros::LaserScan scan = scan_message(some_space(), kStamp, {.robot = 3, .free_space_range = 8});
  EXPECT_EQ(scan.header.frame_id, "robot3/free_space");
  ASSERT_EQ(scan.ranges.size(), 5U);
  EXPECT_TRUE(std::isnan(scan.ranges[0]));                            // unseen
  EXPECT_EQ(scan.ranges[1], std::numeric_limits<float>::infinity());  // free up to the maximal range
  EXPECT_TRUE(std::isnan(scan.ranges[2]));                            // free, but who knows what follows
  EXPECT_TRUE(std::isnan(scan.ranges[3]));
  EXPECT_EQ(scan.ranges[4], 2);  // blocked
  EXPECT_FLOAT_EQ(scan.angle_max, 0.5);
  EXPECT_EQ(scan.range_max, 8);
}

TEST(FreeSpaceMessage, HasTheWholeAnswer) {
  const msgs::FreeSpace message = free_space_message(some_space(), kStamp, {.robot = 3, .free_space_range = 8});
  EXPECT_EQ(message.header.frame_id, "robot3/base_link");
  EXPECT_EQ(message.states, (std::vector<std::uint8_t>{0, 1, 1, 1, 2}));
  EXPECT_TRUE(std::isnan(message.ranges[0]));
  EXPECT_EQ(message.ranges[3], 3);
  EXPECT_EQ(message.origin.x, 0.1);
}

TEST(PoseMessage, KeepsHeadingAndCovariance) {
  PoseSeen pose;
  for (int i = 0; i < 9; ++i) pose.covariance[static_cast<std::size_t>(i)] = i;
  for (double theta = -3.1; theta < 3.1; theta += 0.1) {
    pose.theta = theta;
    const auto message = pose_message(pose, kStamp);
    EXPECT_NEAR(heading_of(message.pose.pose.orientation), theta, 1e-12);
    EXPECT_EQ(message.header.frame_id, "map");
    EXPECT_EQ(message.pose.covariance[0], 0);
    EXPECT_EQ(message.pose.covariance[1], 1);
    EXPECT_EQ(message.pose.covariance[5], 2);
    EXPECT_EQ(message.pose.covariance[11], 5);
    EXPECT_EQ(message.pose.covariance[30], 6);
    EXPECT_EQ(message.pose.covariance[35], 8);
  }
}

TEST(RosTime, IsTheNearestNanosecond) {
  EXPECT_EQ(ros_time(1.9999999999).sec, 2);
  EXPECT_EQ(ros_time(1.9999999999).nanosec, 0U);
  EXPECT_EQ(ros_time(1.25).nanosec, 250'000'000U);
  EXPECT_NEAR(seconds_of(ros_time(1.7e9 + 0.123456)), 1.7e9 + 0.123456, 1e-6);
}

TEST(OdometryMessage, VelocityIsInTheRobotsOwnAxes) {
  Odometry odometry;
  // Ahead at 1 m/s while turning left at .5 rad/s: a circle of radius 2 m.
  for (int i = 0; i <= 200; ++i) {
    const double t = i * 0.01, theta = 0.5 * t;
    odometry.add({t, 2 * std::sin(theta), 2 - 2 * std::cos(theta), theta});
  }
  const auto message = odometry_message(odometry, 1.5, kStamp, {.robot = 2});
  ASSERT_TRUE(message);
  EXPECT_EQ(message->header.frame_id, "robot2/odom");
  EXPECT_EQ(message->child_frame_id, "robot2/base_link");
  EXPECT_NEAR(message->twist.twist.linear.x, 1, 0.001);
  EXPECT_NEAR(message->twist.twist.linear.y, 0, 0.03);  // a chord of the tenth of a second before
  EXPECT_NEAR(message->twist.twist.angular.z, 0.5, 1e-9);
  EXPECT_FALSE(odometry_message(odometry, 9, kStamp, {}));
}

TEST(TransformsMessage, ChainGivesThePose) {
  Scene scene;
  scene.pose.emplace();
  scene.pose->x = 1.2;
  scene.pose->y = -0.7;
  scene.pose->theta = 2.1;
  const OdometrySample odometry{0, 0.4, 0.9, -1.3};
  const ros::TFMessage message = transforms_message(scene, odometry, kStamp, {.robot = 4});
  ASSERT_EQ(message.transforms.size(), 2U);
  const ros::TransformStamped &odom_from_base = message.transforms[0], &map_from_odom = message.transforms[1];
  EXPECT_EQ(odom_from_base.header.frame_id, "robot4/odom");
  EXPECT_EQ(odom_from_base.child_frame_id, "robot4/base_link");
  EXPECT_EQ(map_from_odom.header.frame_id, "map");
  EXPECT_EQ(map_from_odom.child_frame_id, "robot4/odom");
  const double turn = heading_of(map_from_odom.transform.rotation);
  const ros::Vector3 &a = map_from_odom.transform.translation, &b = odom_from_base.transform.translation;
  EXPECT_NEAR(a.x + std::cos(turn) * b.x - std::sin(turn) * b.y, 1.2, 1e-12);
  EXPECT_NEAR(a.y + std::sin(turn) * b.x + std::cos(turn) * b.y, -0.7, 1e-12);
  EXPECT_NEAR(std::remainder(turn + heading_of(odom_from_base.transform.rotation) - 2.1, 2 * std::numbers::pi), 0,
              1e-12);
}

TEST(TransformsMessage, WithoutOdometryTheRobotHangsOnTheMap) {
  Scene scene;
  scene.pose.emplace();
  const ros::TFMessage message = transforms_message(scene, std::nullopt, kStamp, {.robot = 4});
  ASSERT_EQ(message.transforms.size(), 1U);
  EXPECT_EQ(message.transforms[0].child_frame_id, "robot4/base_link");
}

TEST(TransformsMessage, AFrameKeepsItsParentWhileOdometryIsMissing) {
  Scene scene;
  scene.pose.emplace();
  EXPECT_TRUE(transforms_message(scene, std::nullopt, kStamp, {.robot = 4, .has_odometry = true}).transforms.empty());
}

TEST(BallsMessage, LeavesOutWhatIsOnlyInTheImage) {
  Scene scene;
  scene.balls.emplace_back();
  scene.balls.emplace_back();
  scene.balls.back().floor.emplace();
  scene.balls.back().floor->position.mean = {2, 0.5};
  const msgs::BallArray message = balls_message(scene, kStamp, {.robot = 1, .ball_radius = 0.11});
  ASSERT_EQ(message.balls.size(), 1U);
  EXPECT_EQ(message.balls[0].center.x, 2);
  EXPECT_EQ(message.balls[0].center.z, 0.11);
}

}  // namespace
}  // namespace tassilo
