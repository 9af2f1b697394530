#include "tassilo/contour/boundary_contours.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace tassilo {
namespace {

struct Step {
  int columns = 0, rows = 0;
};
/// Right, down, left, up: clockwise on the screen.
constexpr std::array<Step, 4> kSteps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
constexpr int kUp = 3;

/// Answers in which run a pixel is.
class RunIndex {
 public:
  explicit RunIndex(std::span<const PixelRun> runs) : runs_(runs), top_(runs.front().row) {
    begin_of_row_.resize(static_cast<std::size_t>(runs.back().row - top_) + 2);
    std::size_t i = 0;
    for (std::size_t row = 0; row < begin_of_row_.size(); ++row) {
      while (i < runs.size() && runs[i].row < top_ + static_cast<int>(row)) ++i;
      begin_of_row_[row] = i;
    }
  }

  /// Index of the pixel's run; the number of runs when it is in none.
  std::size_t find(int column, int row) const {
    const std::size_t none = runs_.size();
    if (row < top_ || row > runs_.back().row) return none;
    const auto at = static_cast<std::size_t>(row - top_);
    const auto in_row = runs_.subspan(begin_of_row_[at], begin_of_row_[at + 1] - begin_of_row_[at]);
    const auto it = std::ranges::partition_point(in_row, [&](const PixelRun& run) { return run.end <= column; });
    return it != in_row.end() && it->begin <= column ? begin_of_row_[at] + static_cast<std::size_t>(it - in_row.begin())
                                                     : none;
  }
  bool contains(int column, int row) const { return find(column, row) != runs_.size(); }

 private:
  std::span<const PixelRun> runs_;
  int top_ = 0;
  RecycledVector<std::size_t> begin_of_row_;
};

/// Follows the border that runs along the left side of a run, and notes all runs along whose left sides it comes.
BoundaryContour border_along(std::size_t first, std::span<const PixelRun> runs, const RunIndex& index,
                             RecycledVector<char>& seen) {
  BoundaryContour border;
  border.contour.closed = true;
  auto& points = border.contour.points;
  int column = runs[first].begin, row = runs[first].row, side = kUp;
  std::int64_t twice_area = 0;  // of the cracks' polygon; > 0 when it runs clockwise on the screen
  do {
    if (side == kUp) seen[index.find(column, row)] = true;
    const PixelPoint here{double(column), double(row)};
    if (points.empty() || points.back() != here) points.push_back(here);
    const Step ahead = kSteps[static_cast<std::size_t>(side)],
               outwards = kSteps[static_cast<std::size_t>((side + 3) % 4)];
    // Twice the crack's middle, crossed with its direction.
    twice_area += (2 * column + outwards.columns) * ahead.rows - (2 * row + outwards.rows) * ahead.columns;
    const int next_column = column + ahead.columns, next_row = row + ahead.rows;
    if (index.contains(next_column + outwards.columns, next_row + outwards.rows)) {
      column = next_column + outwards.columns;
      row = next_row + outwards.rows;
      side = (side + 3) % 4;
    } else if (index.contains(next_column, next_row)) {
      column = next_column;
      row = next_row;
    } else {
      side = (side + 1) % 4;
    }
  } while (column != runs[first].begin || row != runs[first].row || side != kUp);
  if (points.size() > 1 && points.front() == points.back()) points.pop_back();
  border.hole = twice_area < 0;
  return border;
}

}  // namespace

RecycledVector<BoundaryContour> boundary_contours(const Region& region) {
  RecycledVector<BoundaryContour> borders;
  const auto runs = region.runs();
  if (runs.empty()) return borders;
  const RunIndex index(runs);
  RecycledVector<char> seen(runs.size(), false);
  // Every border comes along the left side of a run.
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (!seen[i]) borders.push_back(border_along(i, runs, index, seen));
  return borders;
}

}  // namespace tassilo
