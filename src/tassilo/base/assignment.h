#pragma once

#include <cstddef>

#include "tassilo/base/recycled.h"

namespace tassilo {

/// What it costs to give a column to a row.
struct CostTable {
  explicit CostTable(std::size_t row_count, std::size_t column_count, double cost)
      : rows(row_count), columns(column_count), costs(row_count * column_count, cost) {}

  double& at(std::size_t row, std::size_t column) { return costs[row * columns + column]; }
  double at(std::size_t row, std::size_t column) const { return costs[row * columns + column]; }

  std::size_t rows, columns;
  RecycledVector<double> costs;  ///< Row by row; finite.
};

/// The column of each row, none twice, such that the sum of all costs is least.
///
/// alone    cost of a row without a column; a pair that costs more is never made
/// returns  one column per row, -1: none
/// source   H. W. Kuhn, "The Hungarian method for the assignment problem", Naval Research Logistics 2, 1955, by
/// shortest
///          augmenting paths
/// cost     O(rows^2 (rows + columns)); safe from any thread
RecycledVector<int> assign(const CostTable& table, double alone);

}  // namespace tassilo
