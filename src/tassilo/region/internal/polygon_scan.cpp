#include "tassilo/region/internal/polygon_scan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/region/internal/coordinate.h"

namespace tassilo {
namespace {

/// Rows and columns from the smallest whole number >= value, cut to [low, high].
int ceil_within(double value, int low, int high) {
  return static_cast<int>(std::clamp(std::ceil(value), static_cast<double>(low), static_cast<double>(high)));
}

}  // namespace

void PolygonScan::add(std::span<const PixelPoint> vertices) {
  if (vertices.size() < 3 || window_.empty()) return;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    PixelPoint top = vertices[i], bottom = vertices[(i + 1) % vertices.size()];
    expects(std::isfinite(top.x) && std::isfinite(top.y), "polygon vertices are finite");
    // The same arithmetic whichever way the edge is walked: polygons that share it get the same crossings.
    if (bottom.y < top.y) std::swap(top, bottom);
    const int first = ceil_within(top.y, window_.y0, window_.y1), end = ceil_within(bottom.y, window_.y0, window_.y1);
    for (int row = first; row < end; ++row) {
      const double share = (row - top.y) / (bottom.y - top.y);
      crossings_.push_back({row, top.x + share * (bottom.x - top.x)});
    }
  }
}

Region PolygonScan::region() && {
  std::ranges::sort(crossings_, [](const Crossing& a, const Crossing& b) { return a < b; });
  // Every row has an even number of crossings, as a closed outline comes back.
  RunVector runs;
  for (std::size_t i = 0; i + 1 < crossings_.size(); i += 2)
    runs.push_back({to_coordinate(crossings_[i].row),
                    to_coordinate(ceil_within(crossings_[i].column, window_.x0, window_.x1)),
                    to_coordinate(ceil_within(crossings_[i + 1].column, window_.x0, window_.x1))});
  return Region::from_runs(std::move(runs));
}

}  // namespace tassilo
