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

TEST(Quantile, IsTheNearestOfTheOrderedValues) {
  const std::vector<int> values{50, 10, 40, 20, 30};
  EXPECT_EQ(quantile(values, 0), 10);
  EXPECT_EQ(quantile(values, 0.12), 10);
  EXPECT_EQ(quantile(values, 0.13), 20);
  EXPECT_EQ(quantile(values, 0.5), median(values));
  EXPECT_EQ(quantile(values, 1), 50);
  EXPECT_EQ(quantile(std::vector<double>{7}, 0.9), 7);
  EXPECT_EQ(quantile(std::vector<int>{1, 2, 3, 4}, 0.5), median(std::vector<int>{1, 2, 3, 4}));
}

TEST(MedianDeathTest, NothingHasNoMiddle) { EXPECT_DEATH(median(std::vector<int>{}), "median of one value or more"); }

}  // namespace
}  // namespace tassilo
