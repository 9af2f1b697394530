#include "tassilo/region/feret.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

#include "tassilo/base/recycled.h"
#include "tassilo/region/features.h"
#include "tassilo/region/internal/line_angle.h"

namespace tassilo {
namespace {

/// Calls visit(i, k) for each side (i, i + 1) of the hull and a corner k that is farthest from it, by turning a caliper
/// once around. Hulls of two corners or more.
template <class Visit>
void turn_caliper(const RecycledVector<PixelPoint>& hull, Visit visit) {
  const auto next = [&](std::size_t i) { return i + 1 < hull.size() ? i + 1 : 0; };
  std::size_t farthest = 1;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const PixelPoint side = hull[next(i)] - hull[i];
    while (cross(side, hull[next(farthest)] - hull[farthest]) > 0) farthest = next(farthest);
    visit(i, farthest);
  }
}

bool in_order(PixelPoint a, PixelPoint b) { return std::tie(a.y, a.x) < std::tie(b.y, b.x); }

/// Whole numbers: squared distances decide exactly.
Diameter diameter_of(const RecycledVector<PixelPoint>& hull) {
  if (hull.empty()) return {};
  Diameter best{hull[0], hull[0], 0};
  if (hull.size() == 1) return best;
  double longest = 0;
  const auto offer = [&](PixelPoint a, PixelPoint b) {
    const double square = dot(b - a, b - a);
    if (square > longest) {
      longest = square;
      best.first = a;
      best.second = b;
    }
  };
  const auto next = [&](std::size_t i) { return i + 1 < hull.size() ? i + 1 : 0; };
  turn_caliper(hull, [&](std::size_t i, std::size_t k) {
    // A side opposite that is parallel has two farthest corners.
    for (const std::size_t from : {i, next(i)})
      for (const std::size_t to : {k, next(k)}) offer(hull[from], hull[to]);
  });
  if (in_order(best.second, best.first)) std::swap(best.first, best.second);
  best.length = std::sqrt(longest);
  return best;
}

}  // namespace

Diameter diameter(const Region& region) { return diameter_of(convex_hull(region)); }

FeretDiameters feret_diameters(const Region& region) {
  const RecycledVector<PixelPoint> hull = convex_hull(region);
  if (hull.size() < 2) return {};
  const Diameter longest = diameter_of(hull);
  FeretDiameters feret;
  feret.max = {longest.length, line_angle(longest.second - longest.first)};
  feret.min.length = std::numeric_limits<double>::infinity();
  turn_caliper(hull, [&](std::size_t i, std::size_t k) {
    const PixelPoint side = hull[i + 1 < hull.size() ? i + 1 : 0] - hull[i];
    const double width = cross(side, hull[k] - hull[i]) / norm(side);
    if (width < feret.min.length) feret.min = {width, line_angle({-side.y, side.x})};
  });
  return feret;
}

double feret_diameter(const Region& region, double angle) {
  const PixelPoint along{std::cos(angle), -std::sin(angle)};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const PixelRun& run : region.runs())
    for (const int column : {int{run.begin}, run.end - 1}) {
      const double at = dot(along, PixelPoint{static_cast<double>(column), static_cast<double>(run.row)});
      low = std::min(low, at);
      high = std::max(high, at);
    }
  return region.empty() ? 0 : high - low;
}

}  // namespace tassilo
