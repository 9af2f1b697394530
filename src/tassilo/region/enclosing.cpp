#include "tassilo/region/enclosing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "tassilo/base/recycled.h"
#include "tassilo/region/features.h"
#include "tassilo/region/internal/coordinate.h"
#include "tassilo/region/internal/line_angle.h"

namespace tassilo {
namespace {

/// What the hull's side from corner `side` on sees: coordinates along and across it, times its length. Whole numbers.
struct SideExtent {
  std::size_t side = 0;
  double first = 0, last = 0, depth = 0;
};

RotatedRectangle rectangle_on(const RecycledVector<PixelPoint>& hull, const SideExtent& extent) {
  const PixelPoint from = hull[extent.side], along = hull[(extent.side + 1) % hull.size()] - from;
  const double square = dot(along, along), length = std::sqrt(square);
  const PixelPoint across{-along.y, along.x};
  RotatedRectangle rectangle;
  rectangle.center =
      from + ((extent.first + extent.last) / (2 * square)) * along + (extent.depth / (2 * square)) * across;
  const double half_along = (extent.last - extent.first) / (2 * length), half_across = extent.depth / (2 * length);
  const double phi_along = line_angle(along), phi_across = line_angle(across);
  const bool long_side =
      half_along > half_across || (half_along == half_across && std::abs(phi_along) <= std::abs(phi_across));
  rectangle.half_length = long_side ? half_along : half_across;
  rectangle.half_width = long_side ? half_across : half_along;
  rectangle.phi = long_side ? phi_along : phi_across;
  return rectangle;
}

Circle circle_of(PixelPoint a, PixelPoint b) { return {.5 * (a + b), distance(a, b) / 2}; }

Circle circle_of(PixelPoint a, PixelPoint b, PixelPoint c) {
  // Relative to a; whole numbers below 2^53, so exact up to the last division. Corners of a hull are never on a line.
  const PixelPoint p = b - a, q = c - a;
  const double pp = dot(p, p), qq = dot(q, q), twice = 2 * cross(p, q);
  const PixelPoint center{(q.y * pp - p.y * qq) / twice, (p.x * qq - q.x * pp) / twice};
  return {a + center, norm(center)};
}

bool holds(const Circle& circle, PixelPoint p) {
  return distance(circle.center, p) <= circle.radius + 1e-9 * (1 + circle.radius);
}

/// The same disorder in every call, so that no hull is a bad case by its order.
void shuffle(RecycledVector<PixelPoint>& points) {
  std::uint32_t state = 12345;
  for (std::size_t i = points.size(); i > 1; --i) {
    state = state * 1664525 + 1013904223;  // Knuth, "The Art of Computer Programming" 2, 3.3.4
    std::swap(points[i - 1], points[(state >> 8) % i]);
  }
}

/// Floor and ceil of a / b, b > 0.
int floor_ratio(std::int64_t a, std::int64_t b) { return static_cast<int>(a >= 0 ? a / b : -((-a + b - 1) / b)); }
int ceil_ratio(std::int64_t a, std::int64_t b) { return -floor_ratio(-a, b); }

}  // namespace

RotatedRectangle smallest_rectangle(const Region& region) {
  const RecycledVector<PixelPoint> hull = convex_hull(region);
  const std::size_t n = hull.size();
  if (n == 0) return {};
  if (n == 1) return {hull.front(), 0, 0, 0};
  const auto next = [&](std::size_t i) { return (i + 1) % n; };
  SideExtent best;
  double best_area = std::numeric_limits<double>::infinity();
  std::size_t last = 1, deepest = 1, first = 1;  // corners farthest along, across and back; they only walk forwards
  for (std::size_t i = 0; i < n; ++i) {
    const PixelPoint side = hull[next(i)] - hull[i];
    while (dot(side, hull[next(last)] - hull[last]) > 0) last = next(last);
    if (i == 0) deepest = last;
    while (cross(side, hull[next(deepest)] - hull[deepest]) > 0) deepest = next(deepest);
    if (i == 0) first = deepest;
    while (dot(side, hull[next(first)] - hull[first]) < 0) first = next(first);
    const SideExtent extent{i, dot(side, hull[first] - hull[i]), dot(side, hull[last] - hull[i]),
                            cross(side, hull[deepest] - hull[i])};
    const double area = (extent.last - extent.first) * extent.depth / dot(side, side);
    if (area < best_area) {
      best = extent;
      best_area = area;
    }
  }
  return rectangle_on(hull, best);
}

Circle smallest_circle(const Region& region) {
  RecycledVector<PixelPoint> points = convex_hull(region);
  if (points.empty()) return {};
  shuffle(points);
  Circle circle{points[0], 0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (holds(circle, points[i])) continue;
    circle = {points[i], 0};
    for (std::size_t j = 0; j < i; ++j) {
      if (holds(circle, points[j])) continue;
      circle = circle_of(points[i], points[j]);
      for (std::size_t k = 0; k < j; ++k)
        if (!holds(circle, points[k])) circle = circle_of(points[i], points[j], points[k]);
    }
  }
  for (const PixelPoint& p : points) circle.radius = std::max(circle.radius, distance(circle.center, p));
  return circle;
}

Region convex_region(const Region& region) {
  if (region.empty()) return {};
  const PixelBox box = bounding_box(region);
  struct Extent {
    int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
    void add(int from, int to) {
      first = std::min(first, from);
      last = std::max(last, to);
    }
  };
  RecycledVector<Extent> rows(static_cast<std::size_t>(box.height()));
  const RecycledVector<PixelPoint> hull = convex_hull(region);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    PixelPoint top = hull[i], bottom = hull[(i + 1) % hull.size()];
    if (bottom.y < top.y) std::swap(top, bottom);
    const auto x = static_cast<std::int64_t>(top.x), dx = static_cast<std::int64_t>(bottom.x) - x;
    const auto y = static_cast<int>(top.y), dy = static_cast<int>(bottom.y) - y;
    rows[static_cast<std::size_t>(y - box.y0)].add(static_cast<int>(x), static_cast<int>(x));
    for (int step = 1; step <= dy; ++step)
      // A hull's side passes between pixels: the next ones inwards. Where it is the other side, that adds nothing.
      rows[static_cast<std::size_t>(y + step - box.y0)].add(ceil_ratio(x * dy + dx * step, dy),
                                                            floor_ratio(x * dy + dx * step, dy));
  }
  RunVector runs;
  runs.reserve(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (rows[k].first <= rows[k].last)
      runs.push_back(
          {to_coordinate(box.y0 + static_cast<int>(k)), to_coordinate(rows[k].first), to_coordinate(rows[k].last + 1)});
  return Region::from_sorted(std::move(runs));
}

}  // namespace tassilo
