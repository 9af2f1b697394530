#include "tassilo/region/algebra.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "tassilo/region/internal/coordinate.h"
#include "tassilo/region/internal/row_sweep.h"
#include "tassilo/region/internal/run_builder.h"

namespace tassilo {
namespace {

/// Pixels for which keep(in a, in b) holds; keep(false, false) must be false.
template <class Keep>
Region combined(const Region& first, const Region& second, Keep keep) {
  const auto a = first.runs(), b = second.runs();
  RunVector runs;
  runs.reserve(a.size() + b.size());
  const auto append = [&](std::span<const PixelRun> row) { runs.insert(runs.end(), row.begin(), row.end()); };
  std::size_t ia = 0, ib = 0;
  while (ia < a.size() || ib < b.size()) {
    const bool only_a = ib == b.size() || (ia < a.size() && a[ia].row < b[ib].row);
    const bool only_b = ia == a.size() || (ib < b.size() && b[ib].row < a[ia].row);
    const std::size_t ja = only_b ? ia : row_end(a, ia), jb = only_a ? ib : row_end(b, ib);
    const auto row_a = a.subspan(ia, ja - ia), row_b = b.subspan(ib, jb - ib);
    if (only_a) {
      if (keep(true, false)) append(row_a);
    } else if (only_b) {
      if (keep(false, true)) append(row_b);
    } else {
      const std::int16_t row = a[ia].row;
      std::int16_t begin = 0;
      bool inside = false;
      sweep_rows(row_a, row_b, [&](int column, bool in_a, bool in_b) {
        if (keep(in_a, in_b) == inside) return;
        if (inside)
          runs.push_back({row, begin, static_cast<std::int16_t>(column)});
        else
          begin = static_cast<std::int16_t>(column);
        inside = !inside;
      });
    }
    ia = ja;
    ib = jb;
  }
  return Region::from_sorted(std::move(runs));
}

/// A number that orders pixels as a region does; cheaper than comparing row and column in turn.
std::int64_t place(int row, int column) { return row * std::int64_t{65536} + column; }

}  // namespace

Region union_of(const Region& first, const Region& second) {
  const auto a = first.runs(), b = second.runs();
  RunBuilder result(a.size() + b.size());
  std::size_t ia = 0, ib = 0;
  while (ia < a.size() && ib < b.size()) {
    const bool from_a = place(a[ia].row, a[ia].begin) < place(b[ib].row, b[ib].begin);
    result.add_joined(from_a ? a[ia] : b[ib]);
    ia += from_a;
    ib += !from_a;
  }
  for (const PixelRun& run : ib == b.size() ? a.subspan(ia) : b.subspan(ib)) result.add_joined(run);
  return std::move(result).region();
}

Region union_of(std::span<const Region> regions) {
  if (regions.empty()) return {};
  if (regions.size() == 1) return regions.front();
  const std::size_t half = regions.size() / 2;
  return union_of(union_of(regions.first(half)), union_of(regions.subspan(half)));
}

Region intersection(const Region& first, const Region& second) {
  const auto a = first.runs(), b = second.runs();
  RunBuilder result(a.size() + b.size());
  std::size_t ia = 0, ib = 0;
  while (ia < a.size() && ib < b.size()) {
    const PixelRun &run_a = a[ia], &run_b = b[ib];
    const auto begin = std::max(run_a.begin, run_b.begin), end = std::min(run_a.end, run_b.end);
    result.add_if_not_empty({run_a.row, begin, run_a.row == run_b.row ? end : begin});
    const bool a_ends_first = place(run_a.row, run_a.end) < place(run_b.row, run_b.end);
    ia += a_ends_first;
    ib += !a_ends_first;
  }
  return std::move(result).region();
}

Region difference(const Region& a, const Region& b) {
  return combined(a, b, [](bool in_a, bool in_b) { return in_a && !in_b; });
}

Region symmetric_difference(const Region& a, const Region& b) {
  return combined(a, b, [](bool in_a, bool in_b) { return in_a != in_b; });
}

Region complement(const Region& region, const PixelBox& domain) { return difference(Region::from_box(domain), region); }

Region translated(const Region& region, PixelShift shift) {
  RunVector runs;
  runs.reserve(region.runs().size());
  for (const PixelRun& run : region.runs())
    runs.push_back({to_coordinate(run.row + shift.rows), to_coordinate(run.begin + shift.columns),
                    to_coordinate(run.end + shift.columns)});
  return Region::from_sorted(std::move(runs));
}

Region clipped(const Region& region, const PixelBox& box) {
  if (box.empty()) return {};
  const auto all = region.runs();
  const auto first = std::ranges::lower_bound(all, box.y0, {}, [](const PixelRun& run) { return int{run.row}; });
  RunVector runs;
  for (auto run = first; run != all.end() && run->row < box.y1; ++run) {
    const int begin = std::max<int>(run->begin, box.x0), end = std::min<int>(run->end, box.x1);
    if (begin < end) runs.push_back({run->row, static_cast<std::int16_t>(begin), static_cast<std::int16_t>(end)});
  }
  return Region::from_sorted(std::move(runs));
}

Region transposed(const Region& region) {
  if (region.empty()) return {};
  // A pixel whose upper neighbor is missing begins a vertical stretch, one whose lower neighbor is missing ends it.
  // Seen by column, the k-th beginning belongs to the k-th ending, as both lists come by rising row.
  const auto all = region.runs();
  const PixelBox box = bounding_box(region);
  RecycledVector<std::size_t> place(static_cast<std::size_t>(box.width()) + 1, 0);
  const auto missing_neighbors = [&](int rows, auto use) {
    // The neighbor's rows are compared as plain numbers: a shifted copy might leave 16 bit.
    for (std::size_t i = 0, j = 0; i < all.size();) {
      const std::size_t i_end = row_end(all, i);
      while (j < all.size() && all[j].row < all[i].row + rows) ++j;
      const std::size_t j_end = j < all.size() && all[j].row == all[i].row + rows ? row_end(all, j) : j;
      int begin = 0;
      bool inside = false;
      sweep_rows(all.subspan(i, i_end - i), all.subspan(j, j_end - j), [&](int column, bool in_row, bool in_neighbor) {
        if (inside)
          for (int c = begin; c < column; ++c) use(static_cast<std::size_t>(c - box.x0), all[i].row);
        inside = in_row && !in_neighbor;
        begin = column;
      });
      i = i_end;
    }
  };
  missing_neighbors(-1, [&](std::size_t column, std::int16_t) { ++place[column + 1]; });
  for (std::size_t c = 1; c < place.size(); ++c) place[c] += place[c - 1];
  RunVector runs(place.back());
  RecycledVector<std::size_t> next = place;
  missing_neighbors(-1, [&](std::size_t column, std::int16_t row) {
    runs[next[column]++] = {to_coordinate(static_cast<int>(column) + box.x0), row, 0};
  });
  next = place;
  missing_neighbors(+1,
                    [&](std::size_t column, std::int16_t row) { runs[next[column]++].end = to_coordinate(row + 1); });
  return Region::from_sorted(std::move(runs));
}

Region reflected(const Region& region) {
  const auto all = region.runs();
  RunVector runs;
  runs.reserve(all.size());
  for (auto run = all.rbegin(); run != all.rend(); ++run)
    runs.push_back({to_coordinate(-run->row), to_coordinate(1 - run->end), to_coordinate(1 - run->begin)});
  return Region::from_sorted(std::move(runs));
}

}  // namespace tassilo
