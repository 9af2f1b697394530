#include "tassilo/base/recycled.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <thread>

namespace tassilo {
namespace {

TEST(Recycled, AFreedBlockServesTheNextVectorOfItsSize) {
  const int* first = nullptr;
  {
    const RecycledVector<int> numbers(1000, 7);
    first = numbers.data();
  }
  const RecycledVector<int> others(900, 1);  // rounds up to the same size
  EXPECT_EQ(others.data(), first);
}

TEST(Recycled, BlocksInUseNeverOverlap) {
  std::mt19937 random(1);
  std::array<RecycledVector<unsigned>, 40> vectors;
  for (unsigned step = 0; step < 3000; ++step) {
    auto& changed = vectors[random() % vectors.size()];
    EXPECT_TRUE(std::ranges::all_of(changed, [&](unsigned value) { return value == changed.front(); }));
    changed = RecycledVector<unsigned>(random() % 70000, step);
  }
}

TEST(Recycled, BlocksMayBeFreedOnAnotherThreadAndComeBack) {
  for (int round = 0; round < 50; ++round) {
    std::vector<RecycledVector<int>> made;
    std::thread([&] {
      for (int i = 0; i < 100; ++i) {
        made.emplace_back(1 + i * 37);
        std::iota(made.back().begin(), made.back().end(), i);
      }
    }).join();
    for (int i = 0; i < 100; ++i) EXPECT_EQ(made[static_cast<std::size_t>(i)].back(), i + i * 37);
  }
}

TEST(Recycled, HugeBlocksGoBackToTheSystem) {
  const RecycledVector<char> huge((std::size_t{64} << 20) + 1, 'x');
  EXPECT_EQ(huge.back(), 'x');
  EXPECT_THROW(RecyclingAllocator<double>().allocate(std::size_t{1} << 62), std::bad_array_new_length);
}

}  // namespace
}  // namespace tassilo
