#include "tassilo/region/partition.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/test_regions.h"

namespace tassilo {
namespace {

std::vector<Region> by_definition(const Region& region, PartSize size) {
  std::vector<Region> parts;
  const PixelBox box = bounding_box(region);
  const int columns = std::max(1, static_cast<int>(std::floor(double(box.width()) / size.width + .5)));
  const int rows = std::max(1, static_cast<int>(std::floor(double(box.height()) / size.height + .5)));
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < columns; ++k) {
      const PixelBox cell{box.x0 + k * box.width() / columns, box.y0 + i * box.height() / rows,
                          box.x0 + (k + 1) * box.width() / columns, box.y0 + (i + 1) * box.height() / rows};
      if (Region part = clipped(region, cell); !part.empty()) parts.push_back(std::move(part));
    }
  return parts;
}

TEST(Partition, CutsAlongTheGrid) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    const Region region = random_case(seed).region;
    for (const PartSize size : {PartSize{1, 1}, {4, 3}, {7, 100}, {1000000000, 2}}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << size.width << " x " << size.height);
      const auto parts = partition_into_rectangles(region, size);
      const auto expected = by_definition(region, size);
      EXPECT_TRUE(std::ranges::equal(parts, expected));
      EXPECT_EQ(union_of(parts), region);
    }
  }
}

TEST(Partition, CellsDifferByOnePixelAtMost) {
  const auto parts = partition_into_rectangles(Region::from_box({-32768, 5, 32767, 6}), {.width = 100, .height = 100});
  ASSERT_EQ(parts.size(), 655u);
  for (const Region& part : parts) EXPECT_NEAR(bounding_box(part).width(), 100, 1);
  EXPECT_TRUE(partition_into_rectangles(Region{}, {3, 3}).empty());
  EXPECT_DEATH(partition_into_rectangles(Region{}, {0, 3}), "at least one pixel");
}

}  // namespace
}  // namespace tassilo
