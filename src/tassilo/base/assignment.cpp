#include "tassilo/base/assignment.h"

#include <algorithm>
#include <limits>

namespace tassilo {

RecycledVector<int> assign(const CostTable& table, double alone) {
  // Each row has a column of its own that means `alone`, so that all rows can be served. Rows and columns are counted
  // from 1; column 0 holds the row that is being served.
  const std::size_t rows = table.rows, columns = table.columns + table.rows;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto cost = [&](std::size_t row, std::size_t column) {
    if (column <= table.columns) return table.at(row - 1, column - 1);
    return column - table.columns == row ? alone : infinity;
  };
  RecycledVector<double> row_price(rows + 1, 0.0), column_price(columns + 1, 0.0), least(columns + 1);
  RecycledVector<std::size_t> row_of(columns + 1, 0), from(columns + 1, 0);
  RecycledVector<char> passed(columns + 1);
  for (std::size_t row = 1; row <= rows; ++row) {
    row_of[0] = row;
    std::ranges::fill(least, infinity);
    std::ranges::fill(passed, 0);
    std::size_t at = 0;
    do {
      passed[at] = 1;
      std::size_t next = 0;
      double step = infinity;
      for (std::size_t column = 1; column <= columns; ++column) {
        if (passed[column]) continue;
        const double reduced = cost(row_of[at], column) - row_price[row_of[at]] - column_price[column];
        if (reduced < least[column]) {
          least[column] = reduced;
          from[column] = at;
        }
        if (least[column] < step) {
          step = least[column];
          next = column;
        }
      }
      for (std::size_t column = 0; column <= columns; ++column)
        if (passed[column]) {
          row_price[row_of[column]] += step;
          column_price[column] -= step;
        } else {
          least[column] -= step;
        }
      at = next;
    } while (row_of[at] != 0);
    for (; at != 0; at = from[at]) row_of[at] = row_of[from[at]];
  }
  RecycledVector<int> column_of(rows, -1);
  for (std::size_t column = 1; column <= table.columns; ++column)
    if (row_of[column] != 0) column_of[row_of[column] - 1] = static_cast<int>(column - 1);
  return column_of;
}

}  // namespace tassilo
