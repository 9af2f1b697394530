#include "tassilo/base/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace tassilo {
namespace {

double least_cost(const CostTable& table, double alone, std::size_t row, std::set<std::size_t> taken) {
  if (row == table.rows) return 0;
  double least = alone + least_cost(table, alone, row + 1, taken);
  for (std::size_t column = 0; column < table.columns; ++column) {
    if (!taken.insert(column).second) continue;
    least = std::min(least, table.at(row, column) + least_cost(table, alone, row + 1, taken));
    taken.erase(column);
  }
  return least;
}

TEST(Assign, CostsAsLittleAsTheBestOfAllAssignments) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_int_distribution<std::size_t> size(0, 5);
    std::uniform_real_distribution<double> number(-5, 20);
    CostTable table(size(random), size(random), 0);
    for (double& cost : table.costs) cost = number(random);
    const double alone = number(random);
    const auto columns = assign(table, alone);
    ASSERT_EQ(columns.size(), table.rows);
    std::set<int> taken;
    double cost = 0;
    for (std::size_t row = 0; row < table.rows; ++row) {
      if (columns[row] >= 0) {
        EXPECT_TRUE(taken.insert(columns[row]).second);
      }
      cost += columns[row] < 0 ? alone : table.at(row, static_cast<std::size_t>(columns[row]));
    }
    EXPECT_NEAR(cost, least_cost(table, alone, 0, {}), 1e-9);
  }
}

TEST(Assign, ARowStaysAloneRatherThanPayMore) {
  CostTable table(2, 1, 1e9);
  table.at(1, 0) = 3;
  EXPECT_EQ(assign(table, 4), (RecycledVector<int>{-1, 0}));
  EXPECT_EQ(assign(table, 2), (RecycledVector<int>{-1, -1}));
}

}  // namespace
}  // namespace tassilo
