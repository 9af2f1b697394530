#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/box.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {
namespace {

constexpr double pi = std::numbers::pi;

TEST(WrapAngle, KeepsDirectionAndRange) {
  for (double angle = -25; angle < 25; angle += 0.01) {
    const double wrapped = wrap_angle(angle);
    EXPECT_GE(wrapped, -pi);
    EXPECT_LT(wrapped, pi);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-12);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-12);
  }
  EXPECT_DOUBLE_EQ(wrap_angle(pi), -pi);
}

TEST(Pose2, InverseUndoesAndCompositionAssociates) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-4, 4);
  for (int i = 0; i < 100; ++i) {
    const auto field_from_robot = make_pose2<FieldFrame, RobotFrame>(any(random), any(random), any(random));
    const FloorPoint p{any(random), any(random)};
    const FloorPoint back = inverse(field_from_robot) * (field_from_robot * p);
    EXPECT_NEAR(distance(back, p), 0, 1e-12);
    const auto round_trip = inverse(field_from_robot) * field_from_robot;
    EXPECT_NEAR(distance(round_trip * p, p), 0, 1e-12);
    EXPECT_NEAR(wrap_angle(field_from_robot.theta() + inverse(field_from_robot).theta()), 0, 1e-12);
  }
}

TEST(PixelBox, HullHoldsBothAndIntersectionLiesInBoth) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> at(-20, 20), size(0, 15);
  for (int i = 0; i < 500; ++i) {
    const int ax = at(random), ay = at(random), bx = at(random), by = at(random);
    const PixelBox a{ax, ay, ax + size(random), ay + size(random)}, b{bx, by, bx + size(random), by + size(random)};
    EXPECT_EQ(intersection(a, b).area(), intersection(b, a).area());
    EXPECT_EQ(intersection(hull(a, b), a).area(), a.area());
    EXPECT_EQ(intersection(hull(a, b), b).area(), b.area());
    const double iou = intersection_over_union(a, b);
    EXPECT_GE(iou, 0);
    EXPECT_LE(iou, 1);
    EXPECT_DOUBLE_EQ(intersection_over_union(a, a), a.empty() ? 0 : 1);
  }
}

}  // namespace
}  // namespace tassilo
