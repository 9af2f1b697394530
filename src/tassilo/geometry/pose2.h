#pragma once

#include <cmath>

#include "tassilo/geometry/point.h"

namespace tassilo {

/// Rigid motion of the plane: p_to = R p_from + t. Names read `field_from_robot`.
/// Invariant: cos^2 + sin^2 = 1.
template <class To, class From>
struct Pose2 {
  double cos = 1, sin = 0, x = 0, y = 0;

  Point2<To> operator*(Point2<From> p) const { return {cos * p.x - sin * p.y + x, sin * p.x + cos * p.y + y}; }
  double theta() const { return std::atan2(sin, cos); }
};

template <class To, class From>
Pose2<To, From> make_pose2(double x, double y, double theta) {
  return {std::cos(theta), std::sin(theta), x, y};
}
template <class A, class B, class C>
Pose2<A, C> operator*(const Pose2<A, B>& a_from_b, const Pose2<B, C>& b_from_c) {
  const Point2<A> t = a_from_b * Point2<B>{b_from_c.x, b_from_c.y};
  return {a_from_b.cos * b_from_c.cos - a_from_b.sin * b_from_c.sin,
          a_from_b.sin * b_from_c.cos + a_from_b.cos * b_from_c.sin, t.x, t.y};
}
template <class To, class From>
Pose2<From, To> inverse(const Pose2<To, From>& p) {
  return {p.cos, -p.sin, -(p.cos * p.x + p.sin * p.y), p.sin * p.x - p.cos * p.y};
}

using FieldFromRobot = Pose2<FieldFrame, RobotFrame>;

}  // namespace tassilo
