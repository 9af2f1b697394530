#include "tassilo/detect/line.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/base/sort_stably.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

/// A place on a line: in the image, as a ray, on the floor.
struct LinePoint {
  PixelPoint pixel;
  Eigen::Vector3d ray;  ///< Unit.
  FloorPoint floor;
  Eigen::Matrix2d per_px;  ///< Floor shift of one pixel along columns and rows. [m/px]
};

std::optional<LinePoint> line_point(const View& view, PixelPoint pixel) {
  const MountedCamera& camera = view.optics->camera;
  const auto ray = camera.ray(pixel);
  const auto floor = camera.floor_point(pixel, 0, longest_distance(view.field));
  if (!ray || !floor) return std::nullopt;
  const auto right = camera.floor_point(pixel + PixelPoint{1, 0}, 0, 1e4);
  const auto below = camera.floor_point(pixel + PixelPoint{0, 1}, 0, 1e4);
  if (!right || !below) return std::nullopt;
  LinePoint point{pixel, {ray->x, ray->y, ray->z}, *floor, {}};
  point.per_px << right->x - floor->x, below->x - floor->x, right->y - floor->y, below->y - floor->y;
  return point;
}

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
  RecycledVector<LinePoint> points;
  for (const PixelPoint& pixel : thinned(pixels))
    if (const auto point = line_point(view, pixel)) points.push_back(*point);
  return points;
}

/// Middles of the line stretches along rows or along columns, whichever is narrower there.
RecycledVector<PixelPoint> line_middles(const View& view) {
  const Surface& surface = view.surface;
  RecycledVector<PixelPoint> middles;
  const auto is_line = [&](int c, int r) { return view.inside(c, r) && surface.at(c, r) == SurfaceKind::line; };
  const auto rows_from = [&](int c, int r, int step) {
    int n = 0;
    while (is_line(c, r + (n + 1) * step)) ++n;
    return n;
  };
  for (int r = 0; r < surface.height; ++r) {
    const auto row = surface.row(r);
    for (auto it = row.begin(); (it = std::find(it, row.end(), SurfaceKind::line)) != row.end();) {
      const auto end = std::find_if(it, row.end(), [](SurfaceKind kind) { return kind != SurfaceKind::line; });
      const int begin = static_cast<int>(it - row.begin()), length = static_cast<int>(end - it);
      it = end;
      const int middle = begin + length / 2;
      if (length <= 1 + rows_from(middle, r, -1) + rows_from(middle, r, 1)) {
        middles.push_back({begin + (length - 1) / 2.0, static_cast<double>(r)});
        continue;
      }
      // Wider than high: the stretch along each column counts, once, where it begins.
      for (int c = begin; c < begin + length; ++c) {
        if (is_line(c, r - 1)) continue;
        const int rows = 1 + rows_from(c, r, 1);
        if (rows < length) middles.push_back({static_cast<double>(c), r + (rows - 1) / 2.0});
      }
    }
  }
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
  for (int r = view.surface.height - 2; r >= 5; --r)
    for (int c = 0; c < view.surface.width; ++c) {
      if (view.surface.is_floor(c, r) || !view.surface.is_floor(c, r + 1)) continue;
      // r is the first pixel above the carpet: a rim of two pixels, then wall.
      int first = r;
      while (first > r - 3 && !is_wall(c, first)) --first;
      if (first > r - 3 && is_wall(c, first - 1) && is_wall(c, first - 2))
        feet.push_back({static_cast<double>(c), (r + first) / 2.0 + 0.5});
    }
  return feet;
}

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

void find_straight(const View& view, RecycledVector<LinePoint> points, LineKind kind, const LineOptions& options,
                   RecycledVector<LineSeen>& out) {
  constexpr int trials = 60;
  const double tolerance =
      options.tolerance_px / std::sqrt(view.optics->camera.model().fx * view.optics->camera.model().fy);
  std::mt19937 random(1);  // the same frame gives the same lines
  RecycledVector<std::pair<double, LineSeen>> found;
  while (points.size() >= static_cast<std::size_t>(options.min_points) &&
         found.size() < static_cast<std::size_t>(options.max_lines)) {
    std::uniform_int_distribution<std::size_t> any(0, points.size() - 1);
    Eigen::Vector3d best_normal = Eigen::Vector3d::Zero();
    std::size_t most = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const std::size_t i = any(random), j = any(random);
      const Eigen::Vector3d normal = points[i].ray.cross(points[j].ray);
      if (normal.norm() < 4 * tolerance) continue;  // too close together to say a direction
      const Eigen::Vector3d unit = normal.normalized();
      const auto count = static_cast<std::size_t>(
          std::ranges::count_if(points, [&](const LinePoint& p) { return std::abs(unit.dot(p.ray)) <= tolerance; }));
      if (count > most) {
        most = count;
        best_normal = unit;
      }
    }
    if (most < static_cast<std::size_t>(options.min_points)) break;
    auto chosen = in_plane(points, best_normal, tolerance);
    chosen = in_plane(points, plane_through(points, chosen), tolerance);
    const Piece piece = longest_piece(points, chosen, options);
    if (piece.points.empty()) break;
    const Eigen::Vector3d normal = plane_through(points, piece.points);
    const LinePoint &first = points[piece.points.front()], &last = points[piece.points.back()];
    const auto p = on_plane_and_floor(view, first, normal), q = on_plane_and_floor(view, last, normal);
    if (p && q && distance(*p, *q) >= options.min_length) {
      LineSeen line;
      line.kind = kind;
      line.image_p = first.pixel;
      line.image_q = last.pixel;
      line.floor = {*p, *q};
      found.emplace_back(distance(*p, *q), std::move(line));
    }
    // What lies on the line, or on its rim, is explained.
    RecycledVector<bool> used(points.size(), false);
    const auto [low_x, high_x] = std::ranges::minmax(first.floor.x, last.floor.x);
    const auto [low_y, high_y] = std::ranges::minmax(first.floor.y, last.floor.y);
    constexpr double rim = 0.05;  // [m]
    for (const std::size_t i : in_plane(points, normal, 2 * tolerance)) {
      const double x = points[i].floor.x, y = points[i].floor.y;
      used[i] = x >= low_x - rim && x <= high_x + rim && y >= low_y - rim && y <= high_y + rim;
    }
    for (const std::size_t i : piece.points) used[i] = true;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (!used[i]) points[kept++] = points[i];
    points.resize(kept);
  }
  sort_stably(found, std::greater<>{}, &std::pair<double, LineSeen>::first);
  for (auto& [length, line] : found) out.push_back(std::move(line));
}

/// Distance of a point from the circle. [px]
double from_circle(const LinePoint& point, FloorPoint center, double radius) {
  const FloorPoint out = point.floor - center;
  const double length = std::max(1e-6, norm(out));
  const Eigen::RowVector2d normal(out.x / length, out.y / length);
  return (length - radius) / std::max(1e-9, (normal * point.per_px).norm());
}

/// |from_circle| <= tolerance, without its divisions and roots.
bool on_circle(const LinePoint& p, FloorPoint center, double radius, double tolerance) {
  const double x = p.floor.x - center.x, y = p.floor.y - center.y, length = std::sqrt(x * x + y * y);
  const double right = x * p.per_px(0, 0) + y * p.per_px(1, 0), below = x * p.per_px(0, 1) + y * p.per_px(1, 1);
  const double off = (length - radius) * length;
  return off * off <= tolerance * tolerance * (right * right + below * below);
}

/// Enough of the circle must show, and most of what should show must: corners and straight lines touch a circle, too,
/// but where it would go on there is carpet.
bool is_supported(const View& view, const RecycledVector<LinePoint>& points, FloorPoint center,
                  const LineOptions& options) {
  constexpr int bins = 36;
  const double radius = view.field.circle_radius;
  std::array<bool, bins> seen{};
  for (const LinePoint& p : points)
    if (on_circle(p, center, radius, options.tolerance_px)) {
      const double turn = (bearing(p.floor - center) + std::numbers::pi) / (2 * std::numbers::pi);
      seen[static_cast<std::size_t>(turn * bins) % bins] = true;
    }
  int supported = 0, missing = 0;
  for (int k = 0; k < bins; ++k) {
    const double angle = (k + 0.5) / bins * 2 * std::numbers::pi - std::numbers::pi;
    const FloorPoint p = center + FloorPoint{radius * std::cos(angle), radius * std::sin(angle)};
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
    const auto point = line_point(view, *pixel);
    const Eigen::RowVector2d outward(std::cos(angle), std::sin(angle));
    missing += view.surface.is_floor(place->column, place->row) && point &&
               view.field.line_width > thinnest_px * (outward * point->per_px).norm();
  }
  return supported * (2 * std::numbers::pi / bins) >= options.min_arc && missing <= supported / 2;
}

/// The centre circle of known radius; takes its points away.
std::optional<CircleSeen> find_circle(const View& view, RecycledVector<LinePoint>& points, const LineOptions& options) {
  const double radius = view.field.circle_radius;
  if (radius <= 0 || points.size() < static_cast<std::size_t>(2 * options.min_points)) return std::nullopt;
  constexpr int trials = 100;
  std::mt19937 random(2);
  std::uniform_int_distribution<std::size_t> any(0, points.size() - 1);
  const auto count = [&](FloorPoint center) {
    return std::ranges::count_if(
        points, [&](const LinePoint& p) { return on_circle(p, center, radius, options.tolerance_px); });
  };
  std::optional<FloorPoint> best;
  std::ptrdiff_t most = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const FloorPoint a = points[any(random)].floor, b = points[any(random)].floor;
    const double chord = distance(a, b);
    if (chord < 0.5 * radius || chord > 1.95 * radius) continue;
    const FloorPoint middle = 0.5 * (a + b);
    const double height = std::sqrt(radius * radius - chord * chord / 4);
    const FloorPoint across{-(b.y - a.y) / chord, (b.x - a.x) / chord};
    for (const double side : {height, -height}) {
      const FloorPoint center = middle + side * across;
      const auto inliers = count(center);
      if (inliers > most) {
        most = inliers;
        best = center;
      }
    }
  }
  if (!best || most < 2 * options.min_points) return std::nullopt;
  FloorPoint center = *best;
  for (int iteration = 0; iteration < 5; ++iteration) {
    Eigen::Matrix2d information = 1e-9 * Eigen::Matrix2d::Identity();
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    for (const LinePoint& p : points) {
      const double e = from_circle(p, center, radius);
      if (std::abs(e) > options.tolerance_px) continue;
      const FloorPoint out = p.floor - center;
      const double length = norm(out);
      const Eigen::Vector2d normal(out.x / length, out.y / length);
      const Eigen::Vector2d by_center = -normal / std::max(1e-9, (normal.transpose() * p.per_px).norm());
      information += by_center * by_center.transpose();
      gradient += e * by_center;
    }
    const Eigen::Vector2d step = -information.ldlt().solve(gradient);
    if (!step.allFinite()) return std::nullopt;
    center = center + FloorPoint{step[0], step[1]};
  }
  if (!is_supported(view, points, center, options)) return std::nullopt;
  std::erase_if(points, [&](const LinePoint& p) { return on_circle(p, center, radius, 1.5 * options.tolerance_px); });
  return CircleSeen{center, radius};
}

}  // namespace

void LineOptions::check() const {
  const auto above = [](const char* name, double value, double low) {
    if (!(value > low))
      throw Error(std::string("line.") + name, "is " + std::to_string(value) + ", must be > " + std::to_string(low));
  };
  above("tolerance_px", tolerance_px, 0);
  above("min_points", min_points, 2);
  above("min_length", min_length, 0);
  above("max_gap", max_gap, 0);
  above("max_lines", max_lines, 0);
  above("min_arc", min_arc, 0);
}

Lines find_lines(const View& view, const LineOptions& options) {
  Lines lines;
  if (view.optics == nullptr) return lines;
  find_straight(view, on_floor(view, wall_feet(view)), LineKind::boundary, options, lines.lines);
  RecycledVector<LinePoint> points = on_floor(view, line_middles(view));
  if (const auto circle = find_circle(view, points, options)) lines.circles.push_back(*circle);
  find_straight(view, std::move(points), LineKind::line, options, lines.lines);
  return lines;
}

}  // namespace tassilo
