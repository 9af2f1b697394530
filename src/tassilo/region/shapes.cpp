#include "tassilo/region/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "tassilo/base/contract.h"

namespace tassilo {
namespace {

constexpr double kSpare = 1e-9;

/// Columns from .. to, both inclusive; none where from > to.
struct Columns {
  double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
};

/// The whole number at least, or at most, as large as the value; it must fit 16 bit.
std::int16_t coordinate(double whole) {
  using Limits = std::numeric_limits<std::int16_t>;
  expects(whole >= Limits::min() && whole <= Limits::max(), "a shape stays within signed 16 bit");
  return static_cast<std::int16_t>(whole);
}

/// The region of a shape `reach` high around row `center`; columns_at(row - center) gives its columns.
template <class ColumnsAt>
Region row_by_row(double center, double reach, ColumnsAt columns_at) {
  expects(std::isfinite(center) && std::isfinite(reach), "a shape is finite");
  const int first = coordinate(std::ceil(center - reach - kSpare)),
            last = coordinate(std::floor(center + reach + kSpare));
  RunVector runs;
  for (int row = first; row <= last; ++row) {
    const Columns columns = columns_at(row - center);
    const double begin = std::ceil(columns.from), end = std::floor(columns.to) + 1;
    if (begin < end) runs.push_back({static_cast<std::int16_t>(row), coordinate(begin), coordinate(end)});
  }
  return Region::from_sorted(std::move(runs));
}

/// Keeps the columns x of a row y (both from the centre) with |x nx + y ny| <= half + kSpare.
void cut(Columns& columns, PixelPoint normal, double half, double y) {
  const double low = -half - kSpare - y * normal.y, high = half + kSpare - y * normal.y;
  if (std::abs(normal.x) < 1e-12) {
    if (low > 0 || high < 0) columns = {1, 0};
    return;
  }
  const auto [from, to] = std::minmax({low / normal.x, high / normal.x});
  columns = {std::max(columns.from, from), std::min(columns.to, to)};
}

}  // namespace

Region circle_region(const Circle& circle) {
  expects(circle.radius >= 0, "a circle's radius is not negative");
  const double radius = circle.radius + kSpare;
  return row_by_row(circle.center.y, circle.radius, [&](double y) {
    const double half = std::sqrt(std::max(0.0, radius * radius - y * y));
    return Columns{circle.center.x - half, circle.center.x + half};
  });
}

Region ellipse_region(PixelPoint center, const EquivalentEllipse& ellipse) {
  expects(ellipse.ra >= 0 && ellipse.rb >= 0, "an ellipse's radii are not negative");
  const double a = ellipse.ra + kSpare, b = ellipse.rb + kSpare;
  const double c = std::cos(ellipse.phi), s = -std::sin(ellipse.phi);  // the long axis, rows downwards
  // ((x c + y s) / a)^2 + ((y c - x s) / b)^2 <= 1 as p x^2 + 2 q y x + r y^2 <= 1, times a^2 b^2.
  const double p = b * b * c * c + a * a * s * s, q = (b * b - a * a) * c * s;
  return row_by_row(center.y, std::hypot(ellipse.ra * s, ellipse.rb * c), [&](double y) {
    // The discriminant in a form that loses nothing: a^2 b^2 (p - y^2).
    const double middle = -q * y / p, half = a * b * std::sqrt(std::max(0.0, p - y * y)) / p;
    return Columns{center.x + middle - half, center.x + middle + half};
  });
}

Region rectangle_region(const RotatedRectangle& rectangle) {
  expects(rectangle.half_length >= 0 && rectangle.half_width >= 0, "a rectangle's sides are not negative");
  const PixelPoint along{std::cos(rectangle.phi), -std::sin(rectangle.phi)}, across{-along.y, along.x};
  const double reach = rectangle.half_length * std::abs(along.y) + rectangle.half_width * std::abs(across.y);
  return row_by_row(rectangle.center.y, reach, [&](double y) {
    Columns columns;
    cut(columns, along, rectangle.half_length, y);
    cut(columns, across, rectangle.half_width, y);
    return Columns{rectangle.center.x + columns.from, rectangle.center.x + columns.to};
  });
}

}  // namespace tassilo
