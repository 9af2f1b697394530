#include "tassilo/base/sort_stably.h"

#include <gtest/gtest.h>

#include <random>

namespace tassilo {
namespace {

TEST(SortStably, EqualsTheStandardLibrarys) {
  std::mt19937 random(1);
  for (int count = 0; count <= 60; ++count) {
    SCOPED_TRACE(count);
    RecycledVector<std::pair<int, int>> values;
    for (int i = 0; i < count; ++i) values.emplace_back(static_cast<int>(random() % 7), i);
    auto expected = values;
    std::ranges::stable_sort(expected, std::greater<>{}, &std::pair<int, int>::first);
    sort_stably(values, std::greater<>{}, &std::pair<int, int>::first);
    EXPECT_EQ(values, expected);
  }
}

}  // namespace
}  // namespace tassilo
