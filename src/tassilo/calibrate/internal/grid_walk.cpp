#include "tassilo/calibrate/internal/grid_walk.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numeric>
#include <utility>

namespace tassilo {
namespace {

constexpr std::size_t kNeighbors = 24;    ///< Known of each point: one step along a foreshortened grid is among them.
constexpr std::size_t kBasisChoices = 6;  ///< Nearest neighbors of a seed of which two are its basis.
constexpr double kStraightest = .3;       ///< Sine of the angle between the basis vectors, at least.
constexpr double kStepTolerance = .3;     ///< How far a point may lie from where it is expected, in steps.
constexpr int kMostSeeds = 1000;
constexpr double kLeastShare = .8;  ///< Of a grid's points.

using Cell = std::pair<int, int>;  // column, row

struct Node {
  int point = 0;
  PixelPoint along[2];  ///< The steps to the next column and row.
};
using Walk = std::map<Cell, Node>;

/// The window of a walk that a target of columns x rows fills best.
struct Window {
  int column = 0, row = 0, columns = 0, rows = 0, inside = 0;
};

std::vector<std::vector<int>> nearest_neighbors(std::span<const PixelPoint> points) {
  std::vector<std::vector<int>> nearest(points.size());
  std::vector<std::pair<double, int>> others;
  for (std::size_t i = 0; i < points.size(); ++i) {
    others.clear();
    for (std::size_t k = 0; k < points.size(); ++k)
      if (k != i) {
        const PixelPoint away = points[k] - points[i];
        others.emplace_back(dot(away, away), static_cast<int>(k));
      }
    const std::size_t count = std::min(kNeighbors, others.size());
    std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(count), others.end());
    for (std::size_t k = 0; k < count; ++k) nearest[i].push_back(others[k].second);
  }
  return nearest;
}

class Walker {
 public:
  Walker(std::span<const PixelPoint> points, const std::function<bool(int, int)>& fits)
      : points_(points), fits_(fits), nearest_(nearest_neighbors(points)) {}

  const std::vector<int>& nearest(int point) const { return nearest_[static_cast<std::size_t>(point)]; }
  PixelPoint position(int point) const { return points_[static_cast<std::size_t>(point)]; }

  /// All that is reached from `seed`; bounded by `reach` steps each way.
  Walk operator()(int seed, PixelPoint to_column, PixelPoint to_row, int reach) const {
    Walk walk;
    std::vector<char> taken(points_.size(), 0);
    std::deque<Cell> open{{0, 0}};
    walk[{0, 0}] = {seed, {to_column, to_row}};
    taken[static_cast<std::size_t>(seed)] = 1;
    while (!open.empty()) {
      const Cell cell = open.front();
      open.pop_front();
      const Node node = walk[cell];
      for (int way = 0; way < 4; ++way) {
        const int axis = way / 2, sign = way % 2 == 0 ? 1 : -1;
        const auto moved = [&](int steps) {
          return axis == 0 ? Cell{cell.first + steps * sign, cell.second}
                           : Cell{cell.first, cell.second + steps * sign};
        };
        const Cell next = moved(1);
        if (std::max(std::abs(next.first), std::abs(next.second)) > reach || walk.contains(next)) continue;
        PixelPoint step = static_cast<double>(sign) * node.along[axis];
        if (const auto behind = walk.find(moved(-1)); behind != walk.end())
          step = position(node.point) - position(behind->second.point);
        const int found = point_near(node.point, position(node.point) + step, kStepTolerance * norm(step), taken);
        if (found < 0) continue;
        taken[static_cast<std::size_t>(found)] = 1;
        Node reached = {found, {node.along[0], node.along[1]}};
        reached.along[axis] = static_cast<double>(sign) * (position(found) - position(node.point));
        walk[next] = reached;
        open.push_back(next);
      }
    }
    return walk;
  }

 private:
  int point_near(int from, PixelPoint place, double reach, const std::vector<char>& taken) const {
    int best = -1;
    for (const int point : nearest(from)) {
      const double away = distance(position(point), place);
      if (away < reach && !taken[static_cast<std::size_t>(point)] && fits_(from, point)) {
        best = point;
        reach = away;
      }
    }
    return best;
  }

  std::span<const PixelPoint> points_;
  const std::function<bool(int, int)>& fits_;
  std::vector<std::vector<int>> nearest_;
};

Window best_window(const Walk& walk, int columns, int rows) {
  int low_column = 0, high_column = 0, low_row = 0, high_row = 0;
  for (const auto& [cell, node] : walk) {
    low_column = std::min(low_column, cell.first);
    high_column = std::max(high_column, cell.first);
    low_row = std::min(low_row, cell.second);
    high_row = std::max(high_row, cell.second);
  }
  // Windows reach beyond the walk: it may have lost a side. sums(c, r): nodes left of c and above r.
  const int width = high_column - low_column + 1 + 2 * columns, height = high_row - low_row + 1 + 2 * rows;
  Eigen::ArrayXXi sums = Eigen::ArrayXXi::Zero(width + 1, height + 1);
  for (const auto& [cell, node] : walk) ++sums(cell.first - low_column + columns + 1, cell.second - low_row + rows + 1);
  for (int r = 1; r <= height; ++r)
    for (int c = 1; c <= width; ++c) sums(c, r) += sums(c - 1, r) + sums(c, r - 1) - sums(c - 1, r - 1);
  Window best;
  for (int r = 0; r + rows <= height; ++r)
    for (int c = 0; c + columns <= width; ++c) {
      const int inside = sums(c + columns, r + rows) - sums(c, r + rows) - sums(c + columns, r) + sums(c, r);
      if (inside > best.inside) best = {c + low_column - columns, r + low_row - rows, columns, rows, inside};
    }
  return best;
}

Lattice cut(const Walk& walk, const Window& window) {
  Lattice lattice{window.columns, window.rows,
                  std::vector<int>(static_cast<std::size_t>(window.columns * window.rows), -1)};
  for (const auto& [cell, node] : walk) {
    const int column = cell.first - window.column, row = cell.second - window.row;
    if (column >= 0 && column < window.columns && row >= 0 && row < window.rows)
      lattice.index[static_cast<std::size_t>(row * window.columns + column)] = node.point;
  }
  return lattice;
}

/// The line of a walk beside the window that holds most points.
int most_beside(const Walk& walk, const Window& window) {
  int left = 0, right = 0, above = 0, below = 0;
  for (const auto& [cell, node] : walk) {
    const int column = cell.first - window.column, row = cell.second - window.row;
    const bool in_rows = row >= 0 && row < window.rows, in_columns = column >= 0 && column < window.columns;
    left += in_rows && column == -1;
    right += in_rows && column == window.columns;
    above += in_columns && row == -1;
    below += in_columns && row == window.rows;
  }
  return std::max({left, right, above, below});
}

bool touches_all_sides(const Lattice& lattice) {
  bool first_row = false, last_row = false, first_column = false, last_column = false;
  for (int c = 0; c < lattice.columns; ++c) {
    first_row |= lattice.at(c, 0) >= 0;
    last_row |= lattice.at(c, lattice.rows - 1) >= 0;
  }
  for (int r = 0; r < lattice.rows; ++r) {
    first_column |= lattice.at(0, r) >= 0;
    last_column |= lattice.at(lattice.columns - 1, r) >= 0;
  }
  return first_row && last_row && first_column && last_column;
}

}  // namespace

int Lattice::count() const {
  return static_cast<int>(std::ranges::count_if(index, [](int point) { return point >= 0; }));
}

Lattice quarter_turn(const Lattice& lattice) {
  Lattice turned{lattice.rows, lattice.columns, {}};
  turned.index.reserve(lattice.index.size());
  for (int r = 0; r < turned.rows; ++r)
    for (int c = 0; c < turned.columns; ++c) turned.index.push_back(lattice.at(r, lattice.rows - 1 - c));
  return turned;
}

LatticeSearch walk_grid(std::span<const PixelPoint> points, int columns, int rows,
                        const std::function<bool(int, int)>& fits) {
  const int wanted = columns * rows;
  const auto few = [&](int found) {
    return std::to_string(found) + " of " + std::to_string(wanted) + " points form a grid, must be at least " +
           std::to_string(static_cast<int>(std::ceil(kLeastShare * wanted)));
  };
  if (static_cast<double>(points.size()) < kLeastShare * wanted) return {{}, few(static_cast<int>(points.size()))};
  const Walker walker(points, fits);
  std::vector<char> explored(points.size(), 0);
  Walk best_walk;
  Window best;
  int seeds = 0;
  for (int seed = 0; seed < static_cast<int>(points.size()) && seeds < kMostSeeds && best.inside < wanted; ++seed) {
    if (explored[static_cast<std::size_t>(seed)]) continue;
    ++seeds;
    const auto& near = walker.nearest(seed);
    const std::size_t choices = std::min(kBasisChoices, near.size());
    for (std::size_t a = 0; a < choices && best.inside < wanted; ++a)
      for (std::size_t b = a + 1; b < choices && best.inside < wanted; ++b) {
        if (!fits(seed, near[a]) || !fits(seed, near[b])) continue;
        PixelPoint to_column = walker.position(near[a]) - walker.position(seed);
        PixelPoint to_row = walker.position(near[b]) - walker.position(seed);
        const double turn = cross(to_column, to_row);
        if (!(std::abs(turn) > kStraightest * norm(to_column) * norm(to_row))) continue;
        if (turn < 0) std::swap(to_column, to_row);
        const Walk walk = walker(seed, to_column, to_row, 2 * std::max(columns, rows));
        if (static_cast<int>(walk.size()) <= best.inside) continue;
        for (const bool turned : {false, true}) {
          if (turned && columns == rows) continue;
          const Window window = best_window(walk, turned ? rows : columns, turned ? columns : rows);
          if (window.inside <= best.inside) continue;
          best = window;
          best_walk = walk;
        }
      }
    // Other points of a large piece would only find it again.
    if (static_cast<double>(best_walk.size()) > .5 * wanted)
      for (const auto& [cell, node] : best_walk) explored[static_cast<std::size_t>(node.point)] = 1;
  }
  if (best.inside < kLeastShare * wanted) return {{}, few(best.inside)};
  if (most_beside(best_walk, best) > std::min(columns, rows) / 2)
    return {{}, "the grid goes on beyond " + std::to_string(columns) + " x " + std::to_string(rows) + " points"};
  Lattice lattice = cut(best_walk, best);
  if (!touches_all_sides(lattice)) return {{}, "a whole side of the grid is missing, so that its points have no names"};
  if (lattice.columns != columns) lattice = quarter_turn(lattice);
  return {std::move(lattice), {}};
}

}  // namespace tassilo
