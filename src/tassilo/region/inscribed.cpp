#include "tassilo/region/inscribed.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "tassilo/base/recycled.h"
#include "tassilo/region/distance.h"

namespace tassilo {
namespace {

/// A stretch of columns that were in the region for `height` rows, up to the row looked at.
struct Bar {
  int first = 0, height = 0;
};

}  // namespace

Circle inner_circle(const Region& region) {
  if (region.empty()) return {};
  const DistanceImage distances = distance_inside(region, bounding_box(region));
  std::int32_t farthest = 0;
  PixelPoint center;
  for (const PixelRun& run : region.runs())
    for (int c = run.begin; c < run.end; ++c)
      if (distances.at(c, run.row) > farthest) {
        farthest = distances.at(c, run.row);
        center = {static_cast<double>(c), static_cast<double>(run.row)};
      }
  return {center, std::sqrt(static_cast<double>(farthest)) - .5};
}

PixelBox inner_rectangle(const Region& region) {
  const auto runs = region.runs();
  const PixelBox box = bounding_box(region);
  PixelBox best;
  RecycledVector<int> height(static_cast<std::size_t>(box.width()), 0), seen = height;
  RecycledVector<Bar> bars;  // rising heights, the last one ends at the column looked at
  for (std::size_t i = 0; i < runs.size();) {
    const std::size_t end = row_end(runs, i);
    const int row = runs[i].row;
    for (const PixelRun& run : runs.subspan(i, end - i)) {
      bars.clear();
      for (int c = run.begin; c <= run.end; ++c) {
        int here = 0;  // behind the run: all bars end
        if (c < run.end) {
          const auto k = static_cast<std::size_t>(c - box.x0);
          here = height[k] = seen[k] == row - 1 && height[k] > 0 ? height[k] + 1 : 1;
          seen[k] = row;
        }
        int first = c;
        while (!bars.empty() && bars.back().height >= here) {
          const Bar bar = bars.back();
          bars.pop_back();
          first = bar.first;
          const PixelBox found{bar.first, row + 1 - bar.height, c, row + 1};
          if (found.area() > best.area()) best = found;
        }
        bars.push_back({first, here});
      }
    }
    i = end;
  }
  return best;
}

}  // namespace tassilo
