#include "tassilo/localize/boundary.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "tassilo/base/option_check.h"
#include "tassilo/base/sort_stably.h"
#include "tassilo/contour/skeleton_contours.h"
#include "tassilo/contour/sub_pixel_edges.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/localize/internal/regression_line.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/skeleton.h"

namespace tassilo {
namespace {

/// A contour's point as it is and undistorted.
struct TwoPoints {
  PixelPoint image, ideal;
};

template <class Point>
double direction(const Point& p, const Point& q) {
  return std::atan2(q.y - p.y, q.x - p.x);
}

/// Distance of `at` from the line through p and q.
template <class Point>
double off_line(const Point& at, const Point& p, const Point& q) {
  const double length = distance(p, q);
  return length > 0 ? std::abs(cross(q - p, at - p)) / length : distance(at, p);
}

BoundaryPiece piece_of(std::span<const TwoPoints> points) {
  const auto line = regression_line<ImageFrame>(points, &TwoPoints::ideal, [](const TwoPoints&) { return 1; });
  const PixelPoint along{std::cos(line.angle), std::sin(line.angle)};
  const auto on_line = [&](PixelPoint p) { return line.middle + dot(p - line.middle, along) * along; };
  return {on_line(points.front().ideal),   on_line(points.back().ideal), line.residual,
          static_cast<int>(points.size()), points.front().image,         points.back().image};
}

/// Cuts points into stretches that stay near their chords.
void split(std::span<const TwoPoints> points, double tolerance, RecycledVector<BoundaryPiece>& pieces) {
  if (points.size() < 2) return;
  double furthest = 0;
  std::size_t at = 0;
  for (std::size_t k = 1; k + 1 < points.size(); ++k) {
    const double off = off_line(points[k].ideal, points.front().ideal, points.back().ideal);
    if (off > furthest) {
      furthest = off;
      at = k;
    }
  }
  if (furthest <= tolerance) {
    pieces.push_back(piece_of(points));
    return;
  }
  split(points.first(at + 1), tolerance, pieces);
  split(points.subspan(at), tolerance, pieces);
}

/// What pieces in the image and segments on the floor are joined by.
struct JoinLimits {
  double angle = 0, offset = 0, gap = 0;
};

/// Joins b to a when both lie on one line; ends are the outermost ones.
template <class Line>
bool join(Line& a, const Line& b, const JoinLimits& limits) {
  if (std::abs(wrap_half_turn(direction(a.p, a.q) - direction(b.p, b.q))) > limits.angle) return false;
  const bool a_longer = distance(a.p, a.q) >= distance(b.p, b.q);
  const Line &longer = a_longer ? a : b, &shorter = a_longer ? b : a;
  if (std::max(off_line(shorter.p, longer.p, longer.q), off_line(shorter.q, longer.p, longer.q)) > limits.offset)
    return false;
  const auto along = longer.q - longer.p;
  const double length = norm(along);
  const auto place = [&](const auto& p) { return dot(p - longer.p, along) / length; };
  const double of_p = place(shorter.p), of_q = place(shorter.q);
  const bool overlap = std::max(of_p, of_q) >= 0 && std::min(of_p, of_q) <= length;
  const double gap = std::min({distance(a.p, b.p), distance(a.p, b.q), distance(a.q, b.p), distance(a.q, b.q)});
  if (!overlap && gap > limits.gap) return false;
  // The line of the longer one, between the outermost ends.
  struct End {
    decltype(a.p) point;
    PixelPoint image;
    double place;
  };
  const End ends[] = {{longer.p, longer.image_p, 0},
                      {longer.q, longer.image_q, length},
                      {shorter.p, shorter.image_p, of_p},
                      {shorter.q, shorter.image_q, of_q}};
  const auto [first, last] = std::ranges::minmax(ends, {}, &End::place);
  Line joined = longer;
  joined.p = first.point;
  joined.q = last.point;
  joined.image_p = first.image;
  joined.image_q = last.image;
  const double na = a.points, nb = b.points;
  joined.residual_px = std::sqrt((na * a.residual_px * a.residual_px + nb * b.residual_px * b.residual_px) / (na + nb));
  joined.points = a.points + b.points;
  a = joined;
  return true;
}

template <class Line>
void join_all(RecycledVector<Line>& lines, const JoinLimits& limits) {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (std::size_t j = i + 1; j < lines.size();)
        if (join(lines[i], lines[j], limits)) {
          lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(j));
          changed = true;
        } else {
          ++j;
        }
  }
}

}  // namespace

void BoundaryOptions::check() const {
  const auto above = [](const std::string& name, double value, double low) {
    check_above("boundary." + name, value, low);
    check_finite("boundary." + name, value);
  };
  above("reach_px", reach_px, 0);
  above("split_px", split_px, 0);
  above("min_length_px", min_length_px, 1);
  above("max_inclination_deg", max_inclination_deg, 0);
  above("join_angle_deg", join_angle_deg, 0);
  above("join_offset_px", join_offset_px, 0);
  above("join_gap_px", join_gap_px, 0);
  above("floor_join_angle_deg", floor_join_angle_deg, 0);
  above("floor_join_offset", floor_join_offset, 0);
  above("floor_join_gap", floor_join_gap, 0);
  if (max_inclination_deg > 90)
    throw Error("boundary.max_inclination_deg", "is " + std::to_string(max_inclination_deg) + ", must be at most 90");
}

Boundary find_boundary(const FrameView& frame, const Region& wall, const Region& field, const MountedCamera& camera,
                       const RayMap& rays, const BoundaryOptions& options) {
  Boundary boundary;
  const PixelBox image{0, 0, frame.width(), frame.height()};
  const Region element = disc(options.reach_px);
  boundary.region = clipped(intersection(dilation(wall, element), dilation(field, element)), image);
  if (options.method == BoundaryMethod::skeleton) {
    const int widest = static_cast<int>(std::ceil(3 * options.reach_px));
    for (SkeletonContour& one : skeleton_contours(skeleton(boundary.region), {.min_points = 5}).contours)
      boundary.contours.push_back(centered(std::move(one.contour), boundary.region, widest));
  } else {
    boundary.contours = sub_pixel_edges(frame, boundary.region);
  }

  const double focal = std::sqrt(camera.model().fx * camera.model().fy);
  RecycledVector<TwoPoints> points;
  for (const Contour& contour : boundary.contours) {
    points.clear();
    for (const PixelPoint& pixel : contour.points) {
      const auto ray = rays.at(pixel);
      if (!ray || ray->z <= 0) continue;
      points.push_back({pixel, {focal * ray->x / ray->z, focal * ray->y / ray->z}});
    }
    split(points, options.split_px, boundary.pieces);
  }

  for (const BoundaryPiece& piece : boundary.pieces) {
    const double inclination = std::abs(wrap_half_turn(direction(piece.p, piece.q)));
    if (distance(piece.p, piece.q) >= options.min_length_px && inclination <= radians(options.max_inclination_deg))
      boundary.lines.push_back(piece);
  }
  join_all(boundary.lines, {radians(options.join_angle_deg), options.join_offset_px, options.join_gap_px});

  for (const BoundaryPiece& line : boundary.lines) {
    const auto on_floor = [&](PixelPoint ideal) {
      return camera.floor_along(camera.robot_from_optical({ideal.x / focal, ideal.y / focal, 1}));
    };
    const auto p = on_floor(line.p), q = on_floor(line.q);
    if (p && q) boundary.segments.push_back({*p, *q, line.residual_px, 0, line.points, line.image_p, line.image_q});
  }
  join_all(boundary.segments,
           {radians(options.floor_join_angle_deg), options.floor_join_offset, options.floor_join_gap});
  // What all points of a line share: two thresholds of color to both sides of the rim, or blur and lens.
  const double shared_px = options.method == BoundaryMethod::skeleton ? 1 : 0.5;
  for (BoundarySegment& segment : boundary.segments) segment.sigma_px = std::hypot(segment.residual_px, shared_px);
  sort_stably(boundary.segments, std::greater<>{}, [](const BoundarySegment& one) { return distance(one.p, one.q); });
  return boundary;
}

}  // namespace tassilo
