#pragma once

#include <Eigen/Core>
#include <cmath>

#include "tassilo/geometry/frames.h"

namespace tassilo {

/// A point (or a vector, where the name says so) in the plane of one frame.
template <class Frame>
struct Point2 {
  double x = 0, y = 0;

  friend Point2 operator+(Point2 a, Point2 b) { return {a.x + b.x, a.y + b.y}; }
  friend Point2 operator-(Point2 a, Point2 b) { return {a.x - b.x, a.y - b.y}; }
  friend Point2 operator*(double s, Point2 a) { return {s * a.x, s * a.y}; }
  friend bool operator==(const Point2&, const Point2&) = default;
};

template <class Frame>
double dot(Point2<Frame> a, Point2<Frame> b) {
  return a.x * b.x + a.y * b.y;
}
/// z component of the cross product: > 0 when b lies counter-clockwise of a (x right, y up).
template <class Frame>
double cross(Point2<Frame> a, Point2<Frame> b) {
  return a.x * b.y - a.y * b.x;
}
template <class Frame>
double norm(Point2<Frame> a) {
  return std::hypot(a.x, a.y);
}
template <class Frame>
double distance(Point2<Frame> a, Point2<Frame> b) {
  return norm(a - b);
}
/// Direction of a as seen from the frame's origin, counter-clockwise from x. [rad]
template <class Frame>
double bearing(Point2<Frame> a) {
  return std::atan2(a.y, a.x);
}

/// A point or a direction (then of any length, or of length 1 where the name says unit) in space.
template <class Frame>
struct Point3 {
  double x = 0, y = 0, z = 0;

  friend Point3 operator+(Point3 a, Point3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Point3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Point3 operator*(double s, Point3 a) { return {s * a.x, s * a.y, s * a.z}; }
  friend bool operator==(const Point3&, const Point3&) = default;
};

template <class Frame>
double dot(Point3<Frame> a, Point3<Frame> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Frame>
Point3<Frame> cross(Point3<Frame> a, Point3<Frame> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Frame>
double norm(Point3<Frame> a) {
  return std::sqrt(dot(a, a));
}
/// a with length 1; a must not be zero.
template <class Frame>
Point3<Frame> normalized(Point3<Frame> a) {
  return (1 / norm(a)) * a;
}

using PixelPoint = Point2<ImageFrame>;  ///< Sub-pixel position (column, row). [px]
using FloorPoint = Point2<RobotFrame>;  ///< On the floor, robot frame. [m]
using FieldPoint = Point2<FieldFrame>;  ///< On the floor, field frame. [m]

/// A position with its 2x2 covariance, both in one frame.
template <class Frame>
struct Gaussian2 {
  Point2<Frame> mean;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();
};

}  // namespace tassilo
