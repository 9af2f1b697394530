#include "tassilo/region/transform.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/region/internal/coordinate.h"

namespace tassilo {
namespace {

/// 2 about as a whole number.
int twice(double about) {
  const double doubled = 2 * about;
  expects(std::abs(doubled) <= 1e6 && doubled == std::floor(doubled), "a mirror lies on a pixel or between two");
  return static_cast<int>(doubled);
}

/// The first pixel whose centre lies beyond the edge `edge - .5`, scaled by `factor`.
std::int16_t scaled_edge(int edge, double factor) {
  const double scaled = std::ceil(edge * factor - .5);
  using Limits = std::numeric_limits<std::int16_t>;
  expects(scaled >= Limits::min() && scaled <= Limits::max(), "run coordinates stay within signed 16 bit");
  return static_cast<std::int16_t>(scaled);
}

}  // namespace

Region mirrored_left_right(const Region& region, double about) {
  const auto all = region.runs();
  const int sum = twice(about);
  RunVector runs;
  runs.reserve(all.size());
  for (std::size_t i = 0; i < all.size();) {
    const std::size_t end = row_end(all, i);
    for (std::size_t k = end; k-- > i;)
      runs.push_back({all[k].row, to_coordinate(sum - all[k].end + 1), to_coordinate(sum - all[k].begin + 1)});
    i = end;
  }
  return Region::from_sorted(std::move(runs));
}

Region mirrored_top_bottom(const Region& region, double about) {
  const auto all = region.runs();
  const int sum = twice(about);
  RunVector runs(all.size());
  auto out = runs.end();
  for (std::size_t i = 0; i < all.size();) {
    const std::size_t end = row_end(all, i);
    out -= static_cast<std::ptrdiff_t>(end - i);
    std::ranges::transform(all.subspan(i, end - i), out, [&](const PixelRun& run) {
      return PixelRun{to_coordinate(sum - run.row), run.begin, run.end};
    });
    i = end;
  }
  return Region::from_sorted(std::move(runs));
}

Region zoomed(const Region& region, ZoomFactors factors) {
  expects(std::isfinite(factors.columns) && std::isfinite(factors.rows) && factors.columns > 0 && factors.rows > 0,
          "zoom factors are positive and finite");
  const auto all = region.runs();
  RunVector runs, row;
  for (std::size_t i = 0; i < all.size();) {
    const std::size_t end = row_end(all, i);
    const int first = scaled_edge(all[i].row, factors.rows), behind = scaled_edge(all[i].row + 1, factors.rows);
    if (first < behind) {
      row.clear();
      for (const PixelRun& run : all.subspan(i, end - i)) {
        const std::int16_t begin = scaled_edge(run.begin, factors.columns);
        const std::int16_t behind_run = scaled_edge(run.end, factors.columns);
        if (begin == behind_run) continue;
        if (!row.empty() && row.back().end == begin)
          row.back().end = behind_run;
        else
          row.push_back({0, begin, behind_run});
      }
      for (int r = first; r < behind; ++r)
        for (const PixelRun& run : row) runs.push_back({static_cast<std::int16_t>(r), run.begin, run.end});
    }
    i = end;
  }
  return Region::from_sorted(std::move(runs));
}

}  // namespace tassilo
