#include "tassilo/region/internal/pixel_patterns.h"

#include <cstddef>
#include <span>

#include "tassilo/region/internal/row_sweep.h"

namespace tassilo {
namespace {

void count_row_pair(std::span<const PixelRun> upper, std::span<const PixelRun> lower, PixelPatterns& patterns) {
  int last = 0;
  bool was_upper = false, was_lower = false;
  sweep_rows(upper, lower, [&](int column, bool in_upper, bool in_lower) {
    // Windows between two changes see the same columns left and right.
    if (was_upper != was_lower) patterns.side += column - last - 1;
    switch (was_upper + was_lower + in_upper + in_lower) {
      case 1:
        ++patterns.one;
        break;
      case 2:
        ++(was_upper == in_lower ? patterns.diagonal : patterns.side);
        break;
      case 3:
        ++patterns.three;
        break;
      default:
        break;
    }
    was_upper = in_upper;
    was_lower = in_lower;
    last = column;
  });
}

}  // namespace

PixelPatterns count_patterns(const Region& region) {
  const auto runs = region.runs();
  PixelPatterns patterns;
  std::span<const PixelRun> above;
  for (std::size_t i = 0; i < runs.size();) {
    const std::size_t end = row_end(runs, i);
    const auto row = runs.subspan(i, end - i);
    if (!above.empty() && above.front().row != row.front().row - 1) {
      count_row_pair(above, {}, patterns);
      above = {};
    }
    count_row_pair(above, row, patterns);
    above = row;
    i = end;
  }
  count_row_pair(above, {}, patterns);
  return patterns;
}

}  // namespace tassilo
