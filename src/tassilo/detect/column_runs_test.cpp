#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

#include "tassilo/detect/internal/column_runs.h"

namespace tassilo {
namespace {

/// Pixel by pixel, as it is defined.
RecycledVector<ColumnRun> plain(const Region& region, int width, int height) {
  RecycledVector<ColumnRun> out;
  for (int c = 0; c < width; ++c)
    for (int r = 0; r < height; ++r) {
      if (!contains(region, c, r) || contains(region, c, r - 1)) continue;
      int foot = r;
      while (contains(region, c, foot + 1)) ++foot;
      out.push_back({c, r, foot, ColorClass::cyan});
    }
  return out;
}

TEST(ColumnRuns, EqualTheColumnsOfTheRegion) {
  std::mt19937 random(1);
  const int width = 23, height = 11;
  for (const int percent : {0, 5, 50, 95, 100})
    for (int round = 0; round < 40; ++round) {
      SCOPED_TRACE(testing::Message() << percent << " %, " << round);
      RunVector pixels;
      for (int r = 0; r < height; ++r)
        for (int c = 0; c < width; ++c)
          if (static_cast<int>(random() % 100) < percent)
            pixels.push_back(
                {static_cast<std::int16_t>(r), static_cast<std::int16_t>(c), static_cast<std::int16_t>(c + 1)});
      const Region region = Region::from_runs(std::move(pixels));
      RecycledVector<ColumnRun> fast;
      add_column_runs(region, ColorClass::cyan, width, fast);
      EXPECT_TRUE(std::ranges::is_sorted(fast, {}, &ColumnRun::foot));
      std::ranges::sort(fast, {}, [](const ColumnRun& run) { return std::pair(run.column, run.top); });
      EXPECT_TRUE(fast == plain(region, width, height));
    }
}

}  // namespace
}  // namespace tassilo
