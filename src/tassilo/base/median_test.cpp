#include "tassilo/base/median.h"

#include <gtest/gtest.h>

#include <random>

namespace tassilo {
namespace {

TEST(Median, IsTheMiddleOfTheSortedValues) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> any(0, 9);
  for (int count = 1; count <= 40; ++count) {
    SCOPED_TRACE(count);
    std::vector<int> values;
    for (int i = 0; i < count; ++i) values.push_back(any(random));
    auto sorted = values;
    std::ranges::sort(sorted);
    EXPECT_EQ(median(values), sorted[static_cast<std::size_t>(count / 2)]);
    EXPECT_EQ(median(values, std::negate<>{}), sorted[static_cast<std::size_t>((count - 1) / 2)]);
  }
}

TEST(MedianDeathTest, NothingHasNoMiddle) { EXPECT_DEATH(median(std::vector<int>{}), "median of one value or more"); }

}  // namespace
}  // namespace tassilo
