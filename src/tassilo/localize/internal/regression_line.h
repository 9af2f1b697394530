#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "tassilo/geometry/point.h"

namespace tassilo {

/// The line nearest to points.
template <class Frame>
struct RegressionLine {
  Point2<Frame> middle;
  double angle = 0;     ///< Of its direction, in [-pi/2, pi/2). [rad]
  double residual = 0;  ///< Root mean square distance of the points.
};

/// By total least squares, each value's point(value) by its weight(value) > 0. At least one value. O(values).
template <class Frame, class Value, class PointOf, class Weight>
RegressionLine<Frame> regression_line(std::span<const Value> values, PointOf point, Weight weight) {
  double sum = 0, x = 0, y = 0;
  for (const Value& value : values) {
    const double w = std::invoke(weight, value);
    const Point2<Frame> p = std::invoke(point, value);
    sum += w;
    x += w * p.x;
    y += w * p.y;
  }
  RegressionLine<Frame> line;
  line.middle = {x / sum, y / sum};
  double xx = 0, xy = 0, yy = 0;
  for (const Value& value : values) {
    const double w = std::invoke(weight, value);
    const Point2<Frame> d = std::invoke(point, value) - line.middle;
    xx += w * d.x * d.x;
    xy += w * d.x * d.y;
    yy += w * d.y * d.y;
  }
  line.angle = 0.5 * std::atan2(2 * xy, xx - yy);
  const double half = 0.5 * (xx + yy), root = std::hypot(0.5 * (xx - yy), xy);
  line.residual = std::sqrt(std::max(half - root, 0.) / sum);
  return line;
}

}  // namespace tassilo
