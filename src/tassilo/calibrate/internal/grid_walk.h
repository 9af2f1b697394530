#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tassilo/geometry/point.h"

namespace tassilo {

/// Points as a grid: index[row * columns + column] counts in the list they came from, -1 where there is none.
struct Lattice {
  int columns = 0, rows = 0;
  std::vector<int> index;

  int at(int column, int row) const {
    return index[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
  int count() const;  ///< Of points that are there.
};

/// The grid seen from the side: what was the last row is the first column. Twice: turned around. A right-handed one
/// stays so.
Lattice quarter_turn(const Lattice& lattice);

struct LatticeSearch {
  std::optional<Lattice> lattice;
  std::string reason;  ///< Empty with a lattice.
};

/// Finds `columns` x `rows` points that form a grid among others, however lens and perspective bend it, as long as each
/// step along a line is like the one before.
///
/// From a point and two of its neighbors as basis, steps are continued to the point nearest to where the last step
/// leads; bases are tried until a grid is full. A result has points on all four sides and at least 4 of 5 of all
/// points; one that goes on beyond them is another target and refused. Its columns and rows are right-handed in the
/// image (column direction x row direction > 0); where it starts is not known: the caller tells by `quarter_turn`.
///
/// points      up to some thousand [px]
/// fits        whether two points may be neighbors, by their size for example
/// cost        O(N^2) for the neighbors, then O(seeds * 15 bases * grid); own
LatticeSearch walk_grid(std::span<const PixelPoint> points, int columns, int rows,
                        const std::function<bool(int, int)>& fits);

}  // namespace tassilo
