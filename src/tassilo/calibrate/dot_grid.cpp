#include "tassilo/calibrate/dot_grid.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tassilo/base/contract.h"
#include "tassilo/calibrate/internal/frame_places.h"
#include "tassilo/calibrate/internal/grid_walk.h"
#include "tassilo/calibrate/internal/image_filters.h"
#include "tassilo/calibrate/internal/plane_map.h"
#include "tassilo/region/components.h"
#include "tassilo/region/features.h"

namespace tassilo {
namespace {

constexpr double kContrast = 24;               ///< Of dot and paper. [gray levels]
constexpr std::int64_t kLeastArea = 8;         ///< [px^2]
constexpr double kMostAnisometry = 5;          ///< Of a dot: seen from 11 degrees above the target's plane.
constexpr double kBulkiness[2] = {.85, 1.12};  ///< 1 for ellipses; pixels make small ones rough.
constexpr double kAreaRatio = 2.5;             ///< Between neighbors, at most.
constexpr double kMarkDistance = .85;          ///< From dot (0, 0) to the triangle's middle along both axes. [pitch]

struct Dot {
  PixelPoint center;
  double area = 0;
};

/// What of the image counts for a dot: an ellipse like it, larger.
struct Around {
  const ShapeFeatures& dot;
  double cos, sin;

  explicit Around(const ShapeFeatures& features)
      : dot(features), cos(std::cos(features.ellipse.phi)), sin(-std::sin(features.ellipse.phi)) {}
  /// Is the pixel within the ellipse with half axes scale * axis + margin?
  bool holds(int column, int row, double scale, double margin) const {
    const double x = column - dot.center.x, y = row - dot.center.y;
    const double a = (x * cos + y * sin) / (scale * dot.ellipse.ra + margin);
    const double b = (-x * sin + y * cos) / (scale * dot.ellipse.rb + margin);
    return a * a + b * b <= 1;
  }
};

/// The centroid of what is darker than the paper around; nothing where the border cuts it. Paper: a plane of brightness
/// through the ring around the dot.
std::optional<PixelPoint> gray_center(ByteView image, const ShapeFeatures& features) {
  const Around around(features);
  constexpr double inner_scale = 1.3, inner_margin = 1.8, outer_scale = 1.75, outer_margin = 2.2;
  const int reach = static_cast<int>(std::ceil(outer_scale * features.ellipse.ra + outer_margin));
  const int column = static_cast<int>(std::lround(features.center.x));
  const int row = static_cast<int>(std::lround(features.center.y));
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  const auto each = [&](auto visit) {
    for (int r = row - reach; r <= row + reach; ++r)
      for (int c = column - reach; c <= column + reach; ++c) {
        const bool inside = around.holds(c, r, inner_scale, inner_margin);
        if (!inside && !around.holds(c, r, outer_scale, outer_margin)) continue;
        if (c < 0 || r < 0 || c >= image.width || r >= image.height) {
          if (inside) return false;
          continue;
        }
        visit(inside, Eigen::Vector3d(1, c - features.center.x, r - features.center.y),
              image.row(r)[static_cast<std::size_t>(c)]);
      }
    return true;
  };
  const bool whole = each([&](bool inside, const Eigen::Vector3d& at, double y) {
    if (inside) return;
    normal += at * at.transpose();
    right += y * at;
  });
  if (!whole) return std::nullopt;
  const Eigen::Vector3d paper = normal.ldlt().solve(right);
  double mass = 0;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  each([&](bool inside, const Eigen::Vector3d& at, double y) {
    if (!inside) return;
    const double dark = paper.dot(at) - y;
    mass += dark;
    moment += dark * at.tail<2>();
  });
  if (!(mass > 0)) return std::nullopt;
  const Eigen::Vector2d offset = moment / mass;
  if (!(offset.norm() < 1 + .5 * features.ellipse.rb)) return std::nullopt;
  return PixelPoint{features.center.x + offset.x(), features.center.y + offset.y()};
}

std::vector<Dot> find_dots(ByteView image, int radius) {
  const auto mask = locally_dark(image, radius, kContrast);
  const ByteView dark{mask.data(), image.width, image.height, image.width};
  std::vector<Dot> dots;
  for (const Region& region : components(region_where(dark, [](int b) { return b != 0; }))) {
    const ShapeFeatures features = shape_features(region);
    const PixelBox& box = features.box;
    if (features.area < kLeastArea || box.x0 == 0 || box.y0 == 0 || box.x1 == image.width || box.y1 == image.height)
      continue;
    if (!(features.anisometry >= 1 && features.anisometry <= kMostAnisometry)) continue;
    if (!(features.bulkiness >= kBulkiness[0] && features.bulkiness <= kBulkiness[1])) continue;
    if (const auto center = gray_center(image, features)) dots.push_back({*center, static_cast<double>(features.area)});
  }
  return dots;
}

/// How bright the image is where the triangle is if the lattice's first point is dot (0, 0); nothing beyond the border.
/// The map from target to image is that of the dots near this corner.
std::optional<double> brightness_at_mark(const GrayPlane& image, const Lattice& lattice, std::span<const Dot> dots) {
  std::vector<Eigen::Vector2d> from, to;
  for (int reach = 3; reach <= std::max(lattice.columns, lattice.rows) && from.size() < 6; ++reach) {
    from.clear();
    to.clear();
    for (int r = 0; r < std::min(reach, lattice.rows); ++r)
      for (int c = 0; c < std::min(reach, lattice.columns); ++c)
        if (const int point = lattice.at(c, r); point >= 0) {
          const PixelPoint seen = dots[static_cast<std::size_t>(point)].center;
          from.emplace_back(c, r);
          to.emplace_back(seen.x, seen.y);
        }
  }
  const auto map = plane_map(from, to);
  if (!map) return std::nullopt;
  double sum = 0;
  constexpr std::array<std::array<double, 2>, 3> offsets{{{0, 0}, {-.06, .06}, {.06, -.06}}};
  for (const auto& offset : offsets) {
    const Eigen::Vector2d at =
        (*map * Eigen::Vector3d(-kMarkDistance + offset[0], -kMarkDistance + offset[1], 1)).hnormalized();
    if (!(at.x() >= 0 && at.y() >= 0 && at.x() <= image.width - 1 && at.y() <= image.height - 1)) return std::nullopt;
    sum += image.sample(at.x(), at.y());
  }
  return sum / static_cast<double>(offsets.size());
}

/// The lattice turned so that it begins beside the triangle; nothing when no corner is the only dark one.
std::optional<Lattice> oriented(const GrayPlane& image, Lattice lattice, std::span<const Dot> dots) {
  double darkest = std::numeric_limits<double>::infinity(), next = darkest, brightest = 0;
  Lattice best;
  int seen = 0;
  const bool is_square = lattice.columns == lattice.rows;
  for (int turn = 0; turn < 4; ++turn, lattice = quarter_turn(lattice)) {
    const auto brightness = brightness_at_mark(image, lattice, dots);
    if (!brightness) continue;
    ++seen;
    brightest = std::max(brightest, *brightness);
    if (*brightness < darkest) {
      next = darkest;
      darkest = *brightness;
      best = lattice;
      if (!is_square && turn % 2 == 1) best = {};  // the mark is on a corner where no such target has it
    } else {
      next = std::min(next, *brightness);
    }
  }
  if (seen < 3 || brightest - darkest < kContrast || 2 * next < darkest + brightest || best.index.empty())
    return std::nullopt;
  return best;
}

}  // namespace

TargetSearch find_dot_grid(ByteView image, const Target& target) {
  expects(target.kind == TargetKind::dots, "find_dot_grid: a target of dots");
  target.check();
  TargetSearch nearest{{}, "the image is too small"};
  if (image.width < 16 || image.height < 16) return nearest;
  // Windows must hold dot and paper; small ones see less of the light's unevenness.
  for (const int share : {24, 12, 48}) {
    const int radius = std::max(5, std::max(image.width, image.height) / share);
    const std::vector<Dot> dots = find_dots(image, radius);
    std::vector<PixelPoint> centers;
    for (const Dot& dot : dots) centers.push_back(dot.center);
    const auto fits = [&](int a, int b) {
      const double ratio = dots[static_cast<std::size_t>(a)].area / dots[static_cast<std::size_t>(b)].area;
      return ratio < kAreaRatio && ratio > 1 / kAreaRatio;
    };
    const LatticeSearch found = walk_grid(centers, target.columns, target.rows, fits);
    if (!found.lattice) {
      if (share == 24) nearest.reason = found.reason;
      continue;
    }
    const auto lattice = oriented(blurred(image, .6), *found.lattice, dots);
    if (!lattice) {
      nearest.reason = "no triangle marks the corner of the grid";
      continue;
    }
    TargetView view{target, {}};
    for (int r = 0; r < lattice->rows; ++r)
      for (int c = 0; c < lattice->columns; ++c)
        if (const int point = lattice->at(c, r); point >= 0)
          view.points.push_back({c, r, centers[static_cast<std::size_t>(point)]});
    view.frame = frame_places(image, view);
    return {std::move(view), {}};
  }
  return nearest;
}

}  // namespace tassilo
