#include "tassilo/region/features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <span>

#include "tassilo/region/algebra.h"
#include "tassilo/region/fill.h"
#include "tassilo/region/internal/pixel_patterns.h"
#include "tassilo/region/raster.h"

namespace tassilo {
namespace {

constexpr double kPi = std::numbers::pi;

/// Sum of k * k for k = 0 .. n - 1.
std::int64_t sum_of_squares(std::int64_t n) { return (n - 1) * n * (2 * n - 1) / 6; }

void add_area_and_moments(std::span<const PixelRun> runs, ShapeFeatures& features) {
  // Whole numbers relative to the first pixel: exact, and a straight line along an axis has a second moment of exactly
  // 0.
  const int column0 = runs.front().begin, row0 = runs.front().row;
  std::int64_t n = 0, sum_r = 0, sum_c = 0, sum_rr = 0, sum_rc = 0, sum_cc = 0;
  for (const PixelRun& run : runs) {
    const std::int64_t length = run.length(), row = run.row - row0, begin = run.begin - column0;
    const std::int64_t steps = length * (length - 1) / 2;  // 0 + 1 + ... + (length - 1)
    const std::int64_t columns = length * begin + steps;
    n += length;
    sum_r += length * row;
    sum_c += columns;
    sum_rr += length * row * row;
    sum_rc += columns * row;
    sum_cc += length * begin * begin + 2 * begin * steps + sum_of_squares(length);
  }
  const double area = static_cast<double>(n);
  const double mean_r = static_cast<double>(sum_r) / area, mean_c = static_cast<double>(sum_c) / area;
  features.area = n;
  features.center = {column0 + mean_c, row0 + mean_r};
  features.moments = {.rr = static_cast<double>(sum_rr) / area - mean_r * mean_r,
                      .rc = static_cast<double>(sum_rc) / area - mean_r * mean_c,
                      .cc = static_cast<double>(sum_cc) / area - mean_c * mean_c};
}

/// Largest squared distance from the point to a pixel centre; it is at the end of a run.
double largest_squared_distance(std::span<const PixelRun> runs, PixelPoint from) {
  double largest = 0;
  for (const PixelRun& run : runs) {
    const double rows = run.row - from.y;
    const double columns = std::max(from.x - run.begin, run.end - 1 - from.x);
    largest = std::max(largest, rows * rows + columns * columns);
  }
  return largest;
}

double contour_length_of(const PixelPatterns& patterns) {
  // See the pixel centres as corners of a surface: a window of four is a square, one of three a triangle, of two a bare
  // edge. A contour walks an edge once for each of its sides that has no surface.
  return static_cast<double>(patterns.side) +
         std::numbers::sqrt2 * static_cast<double>(patterns.three + 2 * patterns.diagonal);
}

std::int64_t euler_number_of(const PixelPatterns& patterns, Connectivity foreground) {
  const std::int64_t diagonals = foreground == Connectivity::eight ? -2 : 2;
  return (patterns.one - patterns.three + diagonals * patterns.diagonal) / 4;
}

/// First and last pixel of every row, by rising row, then column.
RecycledVector<PixelPoint> row_ends(std::span<const PixelRun> runs) {
  RecycledVector<PixelPoint> points;
  for (std::size_t i = 0; i < runs.size();) {
    const std::size_t end = row_end(runs, i);
    const double row = runs[i].row, first = runs[i].begin, last = runs[end - 1].end - 1;
    points.push_back({first, row});
    if (last > first) points.push_back({last, row});
    i = end;
  }
  return points;
}

/// The hull's chain along points in the order given, turning clockwise on the screen (x right, y down) only.
void append_chain(const RecycledVector<PixelPoint>& points, RecycledVector<PixelPoint>& hull) {
  const std::size_t start = hull.size();
  for (const PixelPoint& point : points) {
    while (hull.size() >= start + 2 && cross(hull.back() - hull[hull.size() - 2], point - hull.back()) <= 0)
      hull.pop_back();
    hull.push_back(point);
  }
  hull.pop_back();  // begins the other chain
}

}  // namespace

EquivalentEllipse equivalent_ellipse(const SecondMoments& moments) {
  const double sum = moments.rr + moments.cc, spread = std::hypot(moments.rr - moments.cc, 2 * moments.rc);
  EquivalentEllipse ellipse;
  ellipse.ra = std::sqrt(2 * (sum + spread));
  // Pixels exactly on a line must give 0, not rounding noise; any other region's ratio is far above this.
  ellipse.rb = sum - spread > 1e-14 * sum ? std::sqrt(2 * (sum - spread)) : 0;
  if (spread == 0) return ellipse;
  const double phi = .5 * std::atan2(0 - 2 * moments.rc, moments.cc - moments.rr);  // from 0: never -0
  ellipse.phi = phi <= -kPi / 2 ? kPi / 2 : phi;
  return ellipse;
}

ShapeFeatures shape_features(const Region& region) {
  ShapeFeatures features;
  if (region.empty()) return features;
  const auto runs = region.runs();
  add_area_and_moments(runs, features);
  features.box = bounding_box(region);
  features.ellipse = equivalent_ellipse(features.moments);
  const double area = static_cast<double>(features.area);
  const auto [ra, rb, phi] = features.ellipse;
  features.bulkiness = kPi * ra * rb / area;
  if (rb > 0) {
    features.anisometry = ra / rb;
    features.structure_factor = features.anisometry * features.bulkiness - 1;
  }
  const double largest = largest_squared_distance(runs, features.center);
  features.circularity = area >= kPi * largest ? 1 : area / (kPi * largest);
  return features;
}

double orientation(const Region& region) {
  if (region.empty()) return 0;
  const ShapeFeatures features = shape_features(region);
  const double phi = features.ellipse.phi;
  const PixelPoint axis{std::cos(phi), -std::sin(phi)};
  double ahead = 0, behind = 0;  // largest squared distances from the centre, by side
  for (const PixelRun& run : region.runs())
    for (const int column : {int{run.begin}, run.end - 1}) {
      const PixelPoint from = PixelPoint{static_cast<double>(column), static_cast<double>(run.row)} - features.center;
      double& farthest = dot(axis, from) >= 0 ? ahead : behind;
      farthest = std::max(farthest, dot(from, from));
    }
  // Symmetric regions must not turn around by rounding.
  if (behind <= ahead * (1 + 1e-12)) return phi;
  return phi > 0 ? phi - kPi : phi + kPi;
}

double contour_length(const Region& region) {
  double length = 0;
  for (const Region& component : components(region)) {
    const PixelPatterns patterns = count_patterns(component);
    const bool has_holes = euler_number_of(patterns, Connectivity::eight) < 1;
    length += contour_length_of(has_holes ? count_patterns(fill_holes(component)) : patterns);
  }
  return length;
}

double compactness(const Region& region) {
  if (region.empty()) return 0;
  const double length = contour_length(region);
  return std::max(1.0, length * length / (4 * kPi * static_cast<double>(area(region))));
}

std::int64_t euler_number(const Region& region, Connectivity foreground) {
  return euler_number_of(count_patterns(region), foreground);
}

std::int64_t hole_count(const Region& region, Connectivity foreground) {
  return label_runs(region, foreground).count - euler_number(region, foreground);
}

RecycledVector<PixelPoint> convex_hull(const Region& region) {
  const RecycledVector<PixelPoint> points = row_ends(region.runs());
  if (points.size() < 2) return points;
  RecycledVector<PixelPoint> hull;
  append_chain(points, hull);
  append_chain({points.rbegin(), points.rend()}, hull);
  return hull;
}

std::int64_t convex_area(const Region& region) {
  if (region.empty()) return 0;
  // Pick's theorem: A = inner + border / 2 - 1, so inner + border = A + border / 2 + 1; holds for lines and points,
  // too.
  const RecycledVector<PixelPoint> hull = convex_hull(region);
  std::int64_t twice_area = 0, border = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const PixelPoint p = hull[i], q = hull[(i + 1) % hull.size()];
    twice_area += static_cast<std::int64_t>(cross(p, q));
    border += std::gcd(static_cast<int>(q.x - p.x), static_cast<int>(q.y - p.y));
  }
  return (twice_area + border) / 2 + 1;
}

double convexity(const Region& region) {
  if (region.empty()) return 0;
  return static_cast<double>(area(region)) / static_cast<double>(convex_area(region));
}

double rectangularity(const Region& region) {
  if (region.empty()) return 0;
  const ShapeFeatures features = shape_features(region);
  // A unit square's own moment; a box of w pixels then has w^2 / 12, which makes its half side w / 2.
  const double square = 1.0 / 12;
  const auto& [rr, rc, cc] = features.moments;
  const EquivalentEllipse ellipse = equivalent_ellipse({rr + square, rc, cc + square});
  const double a = ellipse.ra * std::sqrt(3.0) / 2, b = ellipse.rb * std::sqrt(3.0) / 2;
  const PixelPoint along{a * std::cos(ellipse.phi), -a * std::sin(ellipse.phi)};
  const PixelPoint across{b * std::sin(ellipse.phi), b * std::cos(ellipse.phi)};
  const PixelPoint center = features.center;
  const std::array<PixelPoint, 4> corners{center + along + across, center + along - across, center - along - across,
                                          center - along + across};
  const int reach = static_cast<int>(a + b) + 1;
  const int column = static_cast<int>(center.x), row = static_cast<int>(center.y);
  const Region box = region_from_polygon(corners, {column - reach, row - reach, column + reach + 2, row + reach + 2});
  const auto differing = static_cast<double>(area(symmetric_difference(box, region)));
  return std::max(0.0, 1 - differing / (4 * a * b));
}

}  // namespace tassilo
