#include "tassilo/region/elements.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/region/internal/coordinate.h"

namespace tassilo {
namespace {

constexpr int kMostReach = 32766;  // 16 bit

/// |row| <= reach, |column| <= reach, |column| + |row| <= steps.
Region cut_square(int reach, int steps) {
  RunVector runs;
  runs.reserve(static_cast<std::size_t>(2 * reach + 1));
  for (int row = -reach; row <= reach; ++row) {
    const int half = std::min(reach, steps - std::abs(row));
    runs.push_back({to_coordinate(row), to_coordinate(-half), to_coordinate(half + 1)});
  }
  return Region::from_sorted(std::move(runs));
}

}  // namespace

Region diamond(int radius) {
  expects(radius >= 0 && radius <= kMostReach, "a diamond's radius is 0 or more, within 16 bit");
  return cut_square(radius, radius);
}

Region octagon(int radius) {
  expects(radius >= 0 && radius <= kMostReach, "an octagon's radius is 0 or more, within 16 bit");
  return cut_square(radius, static_cast<int>(std::lround(std::numbers::sqrt2 * radius)));
}

Region line_element(const LineShape& shape) {
  expects(shape.length_px >= 1 && shape.length_px <= 2 * kMostReach + 1 && std::isfinite(shape.angle),
          "a line's length is 1 or more, within 16 bit");
  const double half = (shape.length_px - 1) / 2;
  const long column = std::lround(half * std::cos(shape.angle)), row = std::lround(-half * std::sin(shape.angle));
  const long steps = std::max(std::abs(column), std::abs(row));
  RunVector runs;
  for (long k = -steps; k <= steps; ++k) {
    // lround rounds halves away from 0, which makes both halves of the line alike.
    const auto at = [&](long end) {
      return steps == 0 ? 0 : static_cast<int>(std::lround(static_cast<double>(k * end) / static_cast<double>(steps)));
    };
    runs.push_back({to_coordinate(at(row)), to_coordinate(at(column)), to_coordinate(at(column) + 1)});
  }
  return Region::from_runs(std::move(runs));
}

}  // namespace tassilo
