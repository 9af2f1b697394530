#include "tassilo/detect/internal/column_runs.h"

#include <algorithm>
#include <span>

namespace tassilo {

void add_column_runs(const Region& region, ColorClass color, int width, RecycledVector<ColumnRun>& out) {
  const auto runs = region.runs();
  RecycledVector<int> top(static_cast<std::size_t>(width));  // of the run that a column is in
  std::span<const PixelRun> above;                           // runs of the row before
  const auto compare = [&](std::span<const PixelRun> here, int row) {
    // Merges the columns where runs of both rows begin and end; between an odd and an even one the rows differ.
    constexpr int none = 1 << 16;
    const auto end_at = [](std::span<const PixelRun> of, std::size_t k) {
      return k >= 2 * of.size() ? none : k % 2 == 0 ? of[k / 2].begin : of[k / 2].end;
    };
    bool differ = false;
    int from = 0;
    for (std::size_t i = 0, j = 0; i < 2 * above.size() || j < 2 * here.size();) {
      const int a = end_at(above, i), b = end_at(here, j), column = std::min(a, b);
      // Between here and the last end: which of the two is inside tells whether runs begin or end.
      if (differ && i % 2 == 0)
        for (int c = from; c < column; ++c) top[static_cast<std::size_t>(c)] = row;
      else if (differ)
        for (int c = from; c < column; ++c) out.push_back({c, top[static_cast<std::size_t>(c)], row - 1, color});
      i += a == column;
      j += b == column;
      differ = i % 2 != j % 2;
      from = column;
    }
    above = here;
  };
  for (std::size_t i = 0; i < runs.size();) {
    const int row = runs[i].row;
    const std::size_t end = row_end(runs, i);
    if (!above.empty() && above.front().row < row - 1) compare({}, above.front().row + 1);
    compare(runs.subspan(i, end - i), row);
    i = end;
  }
  if (!above.empty()) compare({}, above.front().row + 1);
}

}  // namespace tassilo
