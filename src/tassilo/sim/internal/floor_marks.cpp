#include "tassilo/sim/internal/floor_marks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tassilo/field/field_curves.h"

namespace tassilo {
namespace {

constexpr double kFar = 1e3;  ///< From marks that do not exist. [m]
constexpr double kRim = 0.2;  ///< Beyond the field's bounds that the table knows. [m]

/// Signed distance to a rectangle about the origin.
double to_rectangle(double x, double y, double half_length, double half_width) {
  const double dx = std::abs(x) - half_length, dy = std::abs(y) - half_width;
  return std::hypot(std::max(dx, 0.), std::max(dy, 0.)) + std::min(std::max(dx, dy), 0.);
}

}  // namespace

FloorMarks::FloorMarks(const FieldModel& field) : line_width_(static_cast<float>(field.line_width)) {
  const double half = field.line_width / 2;
  const FieldCurves curves = field_curves(field);
  for (const FieldLine& line : curves.lines) {
    if (line.is_wall || half <= 0) continue;
    FieldPoint p = line.p, q = line.q;
    const double length = distance(p, q);
    if (length <= 0) continue;
    const double ux = (q.x - p.x) / length, uy = (q.y - p.y) / length;
    // Lines that meet at a corner are known by their middles, and the corner is full; none leaves the field.
    if (!line.name.starts_with("segment")) {
      const auto into_field = [&](FieldPoint at) {
        return FieldPoint{std::clamp(at.x, -field.length / 2, field.length / 2),
                          std::clamp(at.y, -field.width / 2, field.width / 2)};
      };
      p = into_field({p.x - half * ux, p.y - half * uy});
      q = into_field({q.x + half * ux, q.y + half * uy});
    }
    strips_.push_back({0.5 * (p + q), ux, uy, distance(p, q) / 2, half});
  }
  for (const FieldArc& arc : curves.arcs)
    if (half > 0) rings_.push_back({arc.center, arc.radius, arc.from, arc.to - arc.from, half});

  const FieldExtent extent = field_extent(field);
  x0_ = static_cast<float>(extent.x.low - kRim);
  y0_ = static_cast<float>(extent.y.low - kRim);
  const double cell = std::max(field.line_width / 4, (extent.x.high - extent.x.low) / 4000);
  per_cell_ = static_cast<float>(1 / cell);
  columns_ = static_cast<int>(std::ceil((extent.x.high - extent.x.low + 2 * kRim) / cell)) + 1;
  rows_ = static_cast<int>(std::ceil((extent.y.high - extent.y.low + 2 * kRim) / cell)) + 1;
  columns_limit_ = static_cast<float>(columns_ - 1);
  rows_limit_ = static_cast<float>(rows_ - 1);
  table_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (int r = 0; r < rows_; ++r)
    for (int c = 0; c < columns_; ++c)
      table_[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c)] =
          static_cast<float>(exact({x0_ + c * cell, y0_ + r * cell}));
}

double FloorMarks::exact(FieldPoint at) const {
  double nearest = kFar;
  for (const Strip& strip : strips_) {
    const FieldPoint to = at - strip.middle;
    nearest = std::min(nearest, to_rectangle(strip.ux * to.x + strip.uy * to.y, strip.ux * to.y - strip.uy * to.x,
                                             strip.half_length, strip.half_width));
  }
  for (const Ring& ring : rings_) {
    const FieldPoint to = at - ring.center;
    const double range = norm(to);
    const double turn = 2 * std::numbers::pi;
    double along = std::fmod(bearing(to) - ring.from, turn);
    if (along < 0) along += turn;
    if (ring.sweep >= turn - 1e-9 || along <= ring.sweep) {
      nearest = std::min(nearest, std::abs(range - ring.radius) - ring.half_width);
      continue;
    }
    // Beyond an end: to the edge that ends the mark.
    for (const double end : {ring.from, ring.from + ring.sweep}) {
      const double x = std::cos(end) * to.x + std::sin(end) * to.y, y = std::cos(end) * to.y - std::sin(end) * to.x;
      nearest = std::min(nearest, to_rectangle(x - ring.radius, y, ring.half_width, 0));
    }
  }
  return nearest;
}

}  // namespace tassilo
