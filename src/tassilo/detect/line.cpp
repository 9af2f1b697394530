#include "tassilo/detect/line.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "tassilo/base/option_check.h"
#include "tassilo/base/sort_stably.h"
#include "tassilo/detect/edge.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

/// A place on a line: in the image, as a ray, on the floor.
struct LinePoint {
  PixelPoint pixel;
  Eigen::Vector3d ray;  ///< Unit.
  FloorPoint floor;
};

constexpr int kMostPoints = 300;  // more do not make a line more certain, only slower

RecycledVector<PixelPoint> thinned(RecycledVector<PixelPoint> pixels) {
  if (pixels.size() <= kMostPoints) return pixels;
  RecycledVector<PixelPoint> kept;
  const double step = static_cast<double>(pixels.size()) / kMostPoints;
  for (double i = 0; i < static_cast<double>(pixels.size()); i += step)
    kept.push_back(pixels[static_cast<std::size_t>(i)]);
  return kept;
}

RecycledVector<LinePoint> on_floor(const View& view, const RecycledVector<PixelPoint>& pixels) {
  const double furthest = longest_distance(view.field);
  RecycledVector<LinePoint> points;
  for (const PixelPoint& pixel : thinned(pixels)) {
    const auto ray = view.optics->ray(pixel);
    if (!ray) continue;
    if (const auto floor = view.optics->camera.floor_along(*ray, 0, furthest))
      points.push_back({pixel, {ray->x, ray->y, ray->z}, *floor});
  }
  return points;
}

/// Takes away the marked ones.
void drop(RecycledVector<LinePoint>& points, const RecycledVector<bool>& marked) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!marked[i]) points[kept++] = points[i];
  points.erase(points.begin() + static_cast<std::ptrdiff_t>(kept), points.end());
}

/// Numbers that look random and are the same for each frame, so that the same frame gives the same lines: a linear
/// congruential generator, of which the upper half is used. Knuth, "The Art of Computer Programming" 2, 3.3.4.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  /// 0 .. below - 1
  std::size_t operator()(std::size_t below) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::size_t>(((state_ >> 32) * below) >> 32);
  }

 private:
  std::uint64_t state_;
};

/// So many random pairs are enough to hold, all but certainly, one from a set that is this share of the points.
int enough_trials(std::size_t inliers, std::size_t points, int most) {
  constexpr double missed = 0.001;
  const double share = static_cast<double>(inliers) / static_cast<double>(points);
  const double needed = std::log(missed) / std::log1p(-std::min(0.999, share * share));
  return needed < most ? static_cast<int>(needed) + 1 : most;
}

/// Middles of the line stretches along rows or along columns, whichever is narrower there.
RecycledVector<PixelPoint> line_middles(const View& view) {
  const Surface& surface = view.surface;
  RecycledVector<PixelPoint> middles;
  /// Line pixels beyond (c, r) along the column, up to `most`.
  const auto rows_from = [&](int c, int r, int step, int most) {
    int n = 0;
    while (n < most && view.inside(c, r + (n + 1) * step) && surface.at(c, r + (n + 1) * step) == SurfaceKind::line)
      ++n;
    return n;
  };
  for_each_line_run(surface, [&](int r, int begin, int end) {
    const int length = end - begin, middle = begin + length / 2;
    if (length <= 1 + rows_from(middle, r, -1, length) + rows_from(middle, r, 1, length)) {
      middles.push_back({begin + (length - 1) / 2.0, static_cast<double>(r)});
      return;
    }
    // Wider than high: the stretch along each column counts, once, where it begins.
    for (int c = begin; c < end; ++c) {
      if (rows_from(c, r, -1, 1) == 1) continue;
      const int rows = 1 + rows_from(c, r, 1, length);
      if (rows < length) middles.push_back({static_cast<double>(c), r + (rows - 1) / 2.0});
    }
  });
  return middles;
}

/// Where, going up a column, carpet ends and a wall begins.
RecycledVector<PixelPoint> wall_feet(const View& view) {
  RecycledVector<PixelPoint> feet;
  const auto wall_color = view.field.walls ? color_class_from(view.field.walls->color) : std::nullopt;
  if (!wall_color) return feet;
  const bool white = *wall_color == ColorClass::white;
  const auto is_wall = [&](int c, int r) {
    return white ? view.surface.at(c, r) == SurfaceKind::wall : view.color(c, r) == *wall_color;
  };
  for_each_floor_end(view.surface, [&](int c, int r) {
    // r is the first pixel above the carpet: a rim of two pixels, then wall.
    constexpr int rim = 2, wall = 3;
    if (r < rim + wall) return;
    int first = r;
    while (first > r - 3 && !is_wall(c, first)) --first;
    if (first > r - 3 && is_wall(c, first - 1) && is_wall(c, first - 2))
      feet.push_back({static_cast<double>(c), (r + first) / 2.0 + 0.5});
  });
  return feet;
}

/// The rays of points, one array a coordinate, so that the compiler compares several at once.
class RayArrays {
 public:
  explicit RayArrays(const RecycledVector<LinePoint>& points) {
    for (const auto& [axis, values] : {std::pair(0, &x_), std::pair(1, &y_), std::pair(2, &z_)}) {
      values->reserve(points.size());
      for (const LinePoint& p : points) values->push_back(static_cast<float>(p.ray[axis]));
    }
  }
  /// Rays within `tolerance` of the plane with unit normal `normal`. [rad]
  std::size_t count_in_plane(const Eigen::Vector3d& normal, double tolerance) const {
    const auto a = static_cast<float>(normal.x()), b = static_cast<float>(normal.y()),
               c = static_cast<float>(normal.z());
    const auto most = static_cast<float>(tolerance);
    std::int32_t count = 0;
    for (std::size_t i = 0; i < x_.size(); ++i) count += std::abs(a * x_[i] + b * y_[i] + c * z_[i]) <= most;
    return static_cast<std::size_t>(count);
  }

 private:
  RecycledVector<float> x_, y_, z_;
};

/// Points whose rays lie in the plane through the eye with unit normal `normal`.
RecycledVector<std::size_t> in_plane(const RecycledVector<LinePoint>& points, const Eigen::Vector3d& normal,
                                     double tolerance) {
  RecycledVector<std::size_t> inside;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::abs(normal.dot(points[i].ray)) <= tolerance) inside.push_back(i);
  return inside;
}

/// Total least squares plane through the eye. Unit normal.
Eigen::Vector3d plane_through(const RecycledVector<LinePoint>& points, const RecycledVector<std::size_t>& chosen) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const std::size_t i : chosen) scatter += points[i].ray * points[i].ray.transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
}

struct Piece {
  RecycledVector<std::size_t> points;  ///< Ordered along the line.
  double length = 0;                   ///< [m]
};

/// The longest piece of the points without a gap, ordered along their line on the floor.
Piece longest_piece(const RecycledVector<LinePoint>& points, RecycledVector<std::size_t> chosen,
                    const LineOptions& options) {
  Piece best;
  if (chosen.size() < 2) return best;
  const auto extent = [&](auto coordinate) {
    const auto [low, high] = std::ranges::minmax_element(chosen, {}, coordinate);
    return coordinate(*high) - coordinate(*low);
  };
  const auto x = [&](std::size_t i) { return points[i].floor.x; };
  const auto y = [&](std::size_t i) { return points[i].floor.y; };
  if (extent(x) >= extent(y))
    std::ranges::sort(chosen, {}, x);
  else
    std::ranges::sort(chosen, {}, y);
  std::size_t from = 0;
  for (std::size_t i = 1; i <= chosen.size(); ++i) {
    // Far away one pixel may span more than the gap allowed.
    const bool ends = i == chosen.size() || [&] {
      const LinePoint &a = points[chosen[i - 1]], &b = points[chosen[i]];
      return distance(a.floor, b.floor) > options.max_gap && distance(a.pixel, b.pixel) > 6;
    }();
    if (!ends) continue;
    const double length = distance(points[chosen[from]].floor, points[chosen[i - 1]].floor);
    if (i - from >= static_cast<std::size_t>(options.min_points) && length > best.length)
      best = {{chosen.begin() + static_cast<std::ptrdiff_t>(from), chosen.begin() + static_cast<std::ptrdiff_t>(i)},
              length};
    from = i;
  }
  return best;
}

/// The pixel's ray moved into the plane, on the floor.
std::optional<FloorPoint> on_plane_and_floor(const View& view, const LinePoint& point, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d ray = point.ray - normal.dot(point.ray) * normal;
  if (ray.z() >= -1e-9) return std::nullopt;
  const RobotPoint eye = view.optics->camera.center();
  const double along = -eye.z / ray.z();
  return FloorPoint{eye.x + along * ray.x(), eye.y + along * ray.y()};
}

/// Uncertainty of one place on an edge, and what all edges of a line share: blur, noise and where the color changes.
constexpr double kEdgeSigma = 0.3, kCommonSigma = 0.3;  // [px]
/// A place of the segmentation is good to half a pixel.
constexpr double kLabelSigma = 0.5;  // [px]

/// How far a place on the floor moves across a line when the mount turns by its uncertainty.
double mount_sigma_across(const View& view, FloorPoint at, FloorPoint across) {
  const MountSigma& sigma = view.optics->mount_sigma;
  const RobotPoint eye = view.optics->camera.center();
  const FloorPoint out = at - foot_of(view.optics->camera);
  const double range = std::max(norm(out), 1e-6);
  const double radial = std::abs(dot(out, across)) / range, sideways = std::abs(cross(out, across)) / range;
  const double by_pitch = (range * range + eye.z * eye.z) / eye.z * sigma.pitch, by_height = range / eye.z * sigma.z;
  return std::hypot(radial * by_pitch, radial * by_height, sideways * range * sigma.yaw);
}

/// The mark at a place of the floor where a line was found, moved to where its edges are.
std::optional<LineMark> mark_at(const View& view, FloorPoint at, FloorPoint across, LineKind kind, int line) {
  const MountedCamera& camera = view.optics->camera;
  if (dot(across, at - foot_of(camera)) < 0) across = -1.0 * across;  // away from us
  constexpr double step = 0.02;                                       // [m]
  const FloorPoint beyond = at + step * across;
  const auto here = camera.project({at.x, at.y, 0}), there = camera.project({beyond.x, beyond.y, 0});
  if (!here || !there) return std::nullopt;
  const double px_per_step = distance(*here, *there);
  if (!(px_per_step > 0)) return std::nullopt;
  const PixelPoint outward = (1 / px_per_step) * (*there - *here);
  const double meters_per_px = step / px_per_step;
  const auto on_floor_at = [&](PixelPoint pixel) -> std::optional<FloorPoint> {
    const auto ray = view.optics->ray(pixel);
    return ray ? camera.floor_along(*ray, 0, longest_distance(view.field)) : std::nullopt;
  };
  LineMark mark{at, across, kEdgeSigma * meters_per_px, 0, kind, line, camera.center()};
  if (kind == LineKind::boundary) {
    const auto edge = find_edge(view.frame, {.at = *here, .outward = outward});
    const auto floor = edge ? on_floor_at(*edge) : std::nullopt;
    if (!floor) return std::nullopt;
    mark.at = *floor;
  } else {
    // Two edges where they are apart, else the middle of the white pixels.
    const double half_px = view.field.line_width / 2 / meters_per_px;
    constexpr double least_half_px = 1.5;
    if (half_px >= least_half_px) {
      const double reach = std::min(3.0, half_px);
      const auto far = find_edge(view.frame, {.at = *here + half_px * outward, .outward = outward, .reach_px = reach});
      const auto near =
          find_edge(view.frame, {.at = *here - half_px * outward, .outward = -1.0 * outward, .reach_px = reach});
      const auto far_floor = far ? on_floor_at(*far) : std::nullopt,
                 near_floor = near ? on_floor_at(*near) : std::nullopt;
      if (!far_floor || !near_floor) return std::nullopt;
      mark.at = 0.5 * (*far_floor + *near_floor);
    } else {
      mark.sigma = kLabelSigma * meters_per_px;
    }
  }
  mark.common_sigma = std::hypot(kCommonSigma * meters_per_px, mount_sigma_across(view, at, across));
  return mark;
}

/// Every n-th of a line's places, so that there are no more than enough.
constexpr std::size_t kMostMarks = 24;
template <class Each>
void for_some(std::size_t count, Each each) {
  const std::size_t some = std::min(count, kMostMarks);
  for (std::size_t k = 0; k < some; ++k) each((2 * k + 1) * count / (2 * some));
}

void find_straight(const View& view, RecycledVector<LinePoint> points, LineKind kind, const LineOptions& options,
                   Lines& out) {
  constexpr int most_trials = 60;
  const double tolerance =
      options.tolerance_px / std::sqrt(view.optics->camera.model().fx * view.optics->camera.model().fy);
  Dice dice(1);
  /// A line, its length and its marks.
  struct Found {
    double length = 0;  ///< [m]
    LineSeen line;
    RecycledVector<LineMark> marks;
  };
  RecycledVector<Found> found;
  while (points.size() >= static_cast<std::size_t>(options.min_points) &&
         found.size() < static_cast<std::size_t>(options.max_lines)) {
    const RayArrays rays(points);
    Eigen::Vector3d best_normal = Eigen::Vector3d::Zero();
    std::size_t most = 0;
    for (int trial = 0, trials = most_trials; trial < trials; ++trial) {
      const std::size_t i = dice(points.size()), j = dice(points.size());
      const Eigen::Vector3d normal = points[i].ray.cross(points[j].ray);
      const double length = normal.norm();
      if (length < 4 * tolerance) continue;  // too close together to say a direction
      const Eigen::Vector3d unit = normal / length;
      const std::size_t count = rays.count_in_plane(unit, tolerance);
      if (count > most) {
        most = count;
        best_normal = unit;
        trials = enough_trials(most, points.size(), most_trials);
      }
    }
    if (most < static_cast<std::size_t>(options.min_points)) break;
    auto chosen = in_plane(points, best_normal, tolerance);
    chosen = in_plane(points, plane_through(points, chosen), tolerance);
    const Piece piece = longest_piece(points, chosen, options);
    RecycledVector<bool> used(points.size(), false);
    if (piece.points.empty()) {
      // Single points that happen to lie in one plane: without them the next best plane may be a line.
      for (const std::size_t i : in_plane(points, best_normal, tolerance)) used[i] = true;
      drop(points, used);
      continue;
    }
    const Eigen::Vector3d normal = plane_through(points, piece.points);
    const LinePoint &first = points[piece.points.front()], &last = points[piece.points.back()];
    const auto p = on_plane_and_floor(view, first, normal), q = on_plane_and_floor(view, last, normal);
    if (p && q && distance(*p, *q) >= options.min_length) {
      LineSeen line;
      line.kind = kind;
      line.image_p = first.pixel;
      line.image_q = last.pixel;
      line.floor = {*p, *q};
      const double length = distance(*p, *q);
      const FloorPoint along = (1 / length) * (*q - *p), across{-along.y, along.x};
      RecycledVector<LineMark> marks;
      for_some(piece.points.size(), [&](std::size_t k) {
        const auto floor = on_plane_and_floor(view, points[piece.points[k]], normal);
        const auto mark = floor ? mark_at(view, *floor, across, kind, 0) : std::nullopt;
        if (mark) marks.push_back(*mark);
      });
      found.push_back({length, std::move(line), std::move(marks)});
    }
    // What lies on the line, or on its rim, is explained.
    const auto [low_x, high_x] = std::ranges::minmax(first.floor.x, last.floor.x);
    const auto [low_y, high_y] = std::ranges::minmax(first.floor.y, last.floor.y);
    constexpr double rim = 0.05;  // [m]
    for (const std::size_t i : in_plane(points, normal, 2 * tolerance)) {
      const double x = points[i].floor.x, y = points[i].floor.y;
      used[i] = x >= low_x - rim && x <= high_x + rim && y >= low_y - rim && y <= high_y + rim;
    }
    for (const std::size_t i : piece.points) used[i] = true;
    drop(points, used);
  }
  sort_stably(found, std::greater<>{}, &Found::length);
  for (Found& one : found) {
    for (LineMark& mark : one.marks) {
      mark.line = static_cast<int>(out.lines.size());
      out.marks.push_back(mark);
    }
    out.lines.push_back(std::move(one.line));
  }
}

/// How far the floor point moves from one pixel to the next, right and down, around a place in the image. [m/px]
struct FloorShift {
  FloorPoint right, below;
};
std::optional<FloorShift> floor_shift(const GroundMap& ground, PixelPoint at) {
  if (ground.width() < 2 || ground.height() < 2) return std::nullopt;
  const int c = std::clamp(static_cast<int>(at.x), 0, ground.width() - 2);
  const int r = std::clamp(static_cast<int>(at.y), 0, ground.height() - 2);
  const auto here = ground.at(c, r), right = ground.at(c + 1, r), below = ground.at(c, r + 1);
  if (!here || !right || !below) return std::nullopt;
  return FloorShift{*right - *here, *below - *here};
}

/// Points for a circle, one array a coordinate, so that the compiler compares several at once.
class CirclePoints {
 public:
  /// Those whose shift on the floor is known.
  CirclePoints(const View& view, const RecycledVector<LinePoint>& points) : radius_(view.field.circle_radius) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const LinePoint& p = points[i];
      const auto shift = floor_shift(view.optics->ground, p.pixel);
      if (!shift) continue;
      source_.push_back(i);
      const double numbers[] = {p.floor.x, p.floor.y, shift->right.x, shift->right.y, shift->below.x, shift->below.y};
      for (std::size_t k = 0; k < columns_.size(); ++k) columns_[k].push_back(static_cast<float>(numbers[k]));
    }
  }

  std::size_t size() const { return source_.size(); }
  std::size_t source(std::size_t i) const { return source_[i]; }  ///< Its place among the points given.
  FloorPoint floor(std::size_t i) const { return {columns_[0][i], columns_[1][i]}; }

  /// How many lie within `tolerance_px` of the circle around `center`; without a root, which would keep the compiler
  /// from comparing several at once: near the circle length - radius is (length^2 - radius^2) / (2 radius).
  std::size_t count(FloorPoint center, double tolerance_px) const {
    const auto cx = static_cast<float>(center.x), cy = static_cast<float>(center.y);
    const auto square_radius = static_cast<float>(radius_ * radius_);
    const auto most = static_cast<float>(4 * radius_ * radius_ * tolerance_px * tolerance_px);
    std::int32_t count = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const float x = columns_[0][i] - cx, y = columns_[1][i] - cy;
      const float right = x * columns_[2][i] + y * columns_[3][i], below = x * columns_[4][i] + y * columns_[5][i];
      const float square = x * x + y * y, off = square - square_radius;
      count += off * off * square <= most * (right * right + below * below);
    }
    return static_cast<std::size_t>(count);
  }
  /// Its distance from the circle [px] and how that changes with the centre, if no more than `tolerance_px`.
  std::optional<Eigen::Vector3d> off_circle(std::size_t i, FloorPoint center, double tolerance_px) const {
    const FloorPoint out = floor(i) - center;
    const double square = dot(out, out), length = std::sqrt(square);
    const double right = out.x * columns_[2][i] + out.y * columns_[3][i];
    const double below = out.x * columns_[4][i] + out.y * columns_[5][i];
    const double off = (length - radius_) * length, shift = right * right + below * below;
    if (!(off * off <= tolerance_px * tolerance_px * shift) || !(shift > 0)) return std::nullopt;
    const double per_meter = length / std::sqrt(shift);  // [px/m] along the radius
    return Eigen::Vector3d((length - radius_) * per_meter, -out.x / length * per_meter, -out.y / length * per_meter);
  }

 private:
  double radius_;
  RecycledVector<std::size_t> source_;
  std::array<RecycledVector<float>, 6> columns_;  ///< floor x, y; shift to the right x, y; below x, y
};

/// Enough of the circle must show, and most of what should show must: corners and straight lines touch a circle, too,
/// but where it would go on there is carpet.
bool is_supported(const View& view, const CirclePoints& points, FloorPoint center, const LineOptions& options) {
  constexpr int bins = 36;
  const double radius = view.field.circle_radius;
  std::array<bool, bins> seen{};
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points.off_circle(i, center, options.tolerance_px)) {
      const double turn = (bearing(points.floor(i) - center) + std::numbers::pi) / (2 * std::numbers::pi);
      seen[static_cast<std::size_t>(turn * bins) % bins] = true;
    }
  int supported = 0, missing = 0;
  for (int k = 0; k < bins; ++k) {
    const double angle = (k + 0.5) / bins * 2 * std::numbers::pi - std::numbers::pi;
    const FloorPoint outward{std::cos(angle), std::sin(angle)}, p = center + radius * outward;
    const auto pixel = view.optics->camera.project({p.x, p.y, 0});
    if (!pixel) continue;
    const auto place = pixel_of(view, *pixel);
    if (!place) continue;
    if (seen[static_cast<std::size_t>(k)]) {
      ++supported;
      continue;
    }
    // A robot, the ball or a wall excuses a missing piece, and so does a line too thin to be seen.
    constexpr double thinnest_px = 2;
    const auto shift = floor_shift(view.optics->ground, *pixel);
    missing += view.surface.is_floor(place->column, place->row) && shift &&
               view.field.line_width > thinnest_px * std::hypot(dot(outward, shift->right), dot(outward, shift->below));
  }
  return supported * (2 * std::numbers::pi / bins) >= options.min_arc && missing <= supported / 2;
}

/// The centre circle of known radius; takes its points away.
std::optional<CircleSeen> find_circle(const View& view, RecycledVector<LinePoint>& all, const LineOptions& options,
                                      RecycledVector<LineMark>& marks) {
  const double radius = view.field.circle_radius;
  const auto least = static_cast<std::size_t>(2 * options.min_points);
  if (radius <= 0 || all.size() < least) return std::nullopt;
  const CirclePoints points(view, all);
  if (points.size() < least) return std::nullopt;
  constexpr int most_trials = 100;
  Dice dice(2);
  FloorPoint center;
  std::size_t most = 0;
  for (int trial = 0, trials = most_trials; trial < trials; ++trial) {
    const FloorPoint a = points.floor(dice(points.size())), b = points.floor(dice(points.size()));
    const double chord = distance(a, b);
    if (chord < 0.5 * radius || chord > 1.95 * radius) continue;
    const FloorPoint middle = 0.5 * (a + b);
    const double height = std::sqrt(radius * radius - chord * chord / 4);
    const FloorPoint across{-(b.y - a.y) / chord, (b.x - a.x) / chord};
    for (const double side : {height, -height}) {
      const FloorPoint here = middle + side * across;
      const std::size_t inliers = points.count(here, options.tolerance_px);
      if (inliers <= most) continue;
      most = inliers;
      center = here;
      trials = enough_trials(most, points.size(), most_trials);
    }
  }
  if (most < least) return std::nullopt;
  for (int iteration = 0; iteration < 5; ++iteration) {
    Eigen::Matrix2d information = 1e-9 * Eigen::Matrix2d::Identity();
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto off = points.off_circle(i, center, options.tolerance_px);
      if (!off) continue;
      const Eigen::Vector2d by_center = off->tail<2>();
      information += by_center * by_center.transpose();
      gradient += off->x() * by_center;
    }
    const Eigen::Vector2d step = -information.ldlt().solve(gradient);
    if (!step.allFinite()) return std::nullopt;
    center = center + FloorPoint{step[0], step[1]};
  }
  if (!is_supported(view, points, center, options)) return std::nullopt;
  RecycledVector<bool> on_circle(all.size(), false);
  RecycledVector<FloorPoint> directions;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.off_circle(i, center, options.tolerance_px)) {
      const FloorPoint out = points.floor(i) - center;
      directions.push_back((1 / norm(out)) * out);
    }
    if (points.off_circle(i, center, 1.5 * options.tolerance_px)) on_circle[points.source(i)] = true;
  }
  for_some(directions.size(), [&](std::size_t k) {
    const auto mark = mark_at(view, center + radius * directions[k], directions[k], LineKind::line, LineMark::kCircle);
    if (mark) marks.push_back(*mark);
  });
  drop(all, on_circle);
  return CircleSeen{center, radius};
}

}  // namespace

void LineOptions::check() const {
  check_above("line.tolerance_px", tolerance_px, 0);
  check_above("line.min_points", min_points, 2);
  check_above("line.min_length", min_length, 0);
  check_above("line.max_gap", max_gap, 0);
  check_above("line.max_lines", max_lines, 0);
  check_above("line.min_arc", min_arc, 0);
}

Lines find_lines(const View& view, const LineOptions& options) {
  Lines lines;
  if (view.optics == nullptr) return lines;
  find_straight(view, on_floor(view, wall_feet(view)), LineKind::boundary, options, lines);
  RecycledVector<LinePoint> points = on_floor(view, line_middles(view));
  if (const auto circle = find_circle(view, points, options, lines.marks)) lines.circles.push_back(*circle);
  find_straight(view, std::move(points), LineKind::line, options, lines);
  return lines;
}

}  // namespace tassilo
