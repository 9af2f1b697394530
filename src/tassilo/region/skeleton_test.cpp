#include "tassilo/region/skeleton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/features.h"
#include "tassilo/region/internal/test_regions.h"
#include "tassilo/region/internal/test_skeleton.h"
#include "tassilo/region/internal/thinning.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/shapes.h"

namespace tassilo {
namespace {

/// Larger shapes that cross many tiles: bars at all angles and rings, some of them together.
Region shapes(unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  Region all;
  for (int k = 0; k < 4; ++k) {
    const PixelPoint center{below(220) - 60.0, below(120) - 40.0};
    const double phi = below(180) * std::numbers::pi / 180 - std::numbers::pi / 2;
    const double half_length = 5 + below(90), half_width = .5 + below(9), radius = 8 + below(30);
    const Region ring = difference(circle_region({center, radius + half_width}),
                                   circle_region({center, std::max(0., radius - half_width)}));
    all = union_of(all, below(3) == 0 ? ring : rectangle_region({center, half_length, half_width, phi}));
  }
  return all;
}
constexpr unsigned kShapes = 30;

/// The mask whose pixel i, row by row, is bit i.
Region region_of_bits(unsigned bits, int width, int height) {
  RunVector runs;
  for (int i = 0; i < width * height; ++i)
    if (bits >> i & 1) {
      const auto row = static_cast<std::int16_t>(i / width), column = static_cast<std::int16_t>(i % width);
      runs.push_back({row, column, static_cast<std::int16_t>(column + 1)});
    }
  return Region::from_runs(std::move(runs));
}

/// Parts, holes, and that every part of the region holds exactly one part of the skeleton.
void expect_same_topology(const Region& region, const Region& thin) {
  ASSERT_EQ(difference(thin, region), Region{}) << "is no subset";
  ASSERT_EQ(euler_number(thin), euler_number(region));
  const auto parts = components(region);
  ASSERT_EQ(components(thin).size(), parts.size());
  for (const Region& part : parts) ASSERT_EQ(components(intersection(thin, part)).size(), 1u);
}

TEST(Skeleton, EqualsThePlainOneWithEveryKernel) {
  for (const ThinningKernel& kernel : thinning_kernels()) {
    if (!is_supported(kernel.kernel)) continue;
    SCOPED_TRACE(std::string(to_string(kernel.kernel)));
    for (unsigned seed = 0; seed < kRandomCases; ++seed) {
      const Region region = random_case(seed).region;
      ASSERT_EQ(skeleton_by(kernel, region), plain_skeleton(region)) << seed;
    }
    for (unsigned seed = 0; seed < 8; ++seed)
      ASSERT_EQ(skeleton_by(kernel, shapes(seed)), plain_skeleton(shapes(seed))) << seed;
  }
}

TEST(Skeleton, KeepsPartsAndHolesOfAllSmallMasks) {
  for (unsigned bits = 0; bits < 1u << 16; ++bits) {
    const Region region = region_of_bits(bits, 4, 4), thin = skeleton(region);
    ASSERT_EQ(euler_number(thin), euler_number(region)) << bits;
    ASSERT_EQ(label_runs(thin).count, label_runs(region).count) << bits;
  }
}

TEST(Skeleton, KeepsPartsAndHolesOfRandomMasksAndShapes) {
  for (unsigned seed = 0; seed < 3 * kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    expect_same_topology(region, skeleton(region));
  }
  for (unsigned seed = 0; seed < kShapes; ++seed) {
    SCOPED_TRACE(seed);
    expect_same_topology(shapes(seed), skeleton(shapes(seed)));
  }
}

TEST(Skeleton, OfASkeletonIsItself) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    const Region thin = skeleton(random_case(seed).region);
    ASSERT_EQ(skeleton(thin), thin) << seed;
  }
  for (unsigned seed = 0; seed < kShapes; ++seed) {
    const Region thin = skeleton(shapes(seed));
    ASSERT_EQ(skeleton(thin), thin) << seed;
  }
}

TEST(Skeleton, MovesWithTheRegion) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Region region = seed % 2 == 0 ? shapes(seed) : random_case(seed).region;
    const int x = static_cast<int>(seed * 37 % 131) - 65, y = static_cast<int>(seed * 11 % 19) - 9;
    for (const PixelShift shift : {PixelShift{x, y}, PixelShift{32000, -32000}, PixelShift{-32000, 32000}})
      ASSERT_EQ(skeleton(translated(region, shift)), translated(skeleton(region), shift)) << seed;
  }
}

TEST(Skeleton, IsOnePixelWide) {
  for (unsigned seed = 0; seed < 2 * kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region thin = skeleton(seed % 4 == 0 ? shapes(seed) : random_case(seed).region);
    for (const PixelRun& run : thin.runs())
      for (int c = run.begin; c < run.end; ++c) {
        const NeighborFlags around = neighbor_flags(thin, c, run.row);
        ASSERT_FALSE(in_full_square(around) && changes_around(around) == 1) << c << ", " << run.row;
        ASSERT_FALSE(guo_hall_deletes(around, true) || guo_hall_deletes(around, false)) << c << ", " << run.row;
      }
  }
}

TEST(Skeleton, OfBandsIsTheirMiddle) {
  for (int width = 1; width <= 40; ++width)
    for (const int x : {-90, -64, -3, 0, 29}) {
      const Region band = Region::from_box({x, -20, x + 200, -20 + width});
      const Region lying = clipped(skeleton(band), {x + width, -100, x + 200 - width, 100});
      const Region upright = clipped(skeleton(transposed(band)), {-100, x + width, 100, x + 200 - width});
      for (const PixelRun& run : lying.runs()) EXPECT_EQ(run.row, -20 + width / 2) << "the lower one of two";
      for (const PixelRun& run : upright.runs()) {
        EXPECT_EQ(run.begin, -20 + (width - 1) / 2) << "the left one of two";
        EXPECT_EQ(run.length(), 1);
      }
      EXPECT_GE(area(skeleton(band)), 200 - width) << "as long as the band, less half its width at each end";
    }
}

TEST(Skeleton, OfTurnedBandsStaysNearTheirMiddle) {
  for (int angle_deg = 0; angle_deg < 180; angle_deg += 7) {
    SCOPED_TRACE(angle_deg);
    const double angle = angle_deg * std::numbers::pi / 180;
    const auto along = [&](int c, int r) { return c * std::cos(angle) + r * std::sin(angle); };
    const auto across = [&](int c, int r) { return r * std::cos(angle) - c * std::sin(angle); };
    const Region band = region_by_pixel({-100, -100, 101, 101}, [&](int c, int r) {
      return std::abs(along(c, r)) <= 90 && std::abs(across(c, r)) <= 5.5;
    });
    double sum = 0, count = 0;
    const Region thin = skeleton(band);
    for (const PixelRun& run : thin.runs())
      for (int c = run.begin; c < run.end; ++c) {
        if (std::abs(along(c, run.row)) > 80) continue;
        EXPECT_LE(std::abs(across(c, run.row)), 1.5);
        sum += across(c, run.row);
        ++count;
      }
    EXPECT_GE(count, 160 / std::numbers::sqrt2);
    EXPECT_LE(std::abs(sum / count), .55);
  }
}

TEST(Skeleton, LeavesLinesAsTheyAre) {
  EXPECT_EQ(skeleton({}), Region{});
  EXPECT_EQ(skeleton(rectangle(1, 1)), rectangle(1, 1));
  for (const int length : {2, 3, 63, 64, 65, 129, 300}) {
    EXPECT_EQ(skeleton(rectangle(length, 1)), rectangle(length, 1));
    EXPECT_EQ(skeleton(rectangle(1, length)), rectangle(1, length));
    RunVector falling, rising;
    for (int k = 0; k < length; ++k) {
      falling.push_back({static_cast<std::int16_t>(k), static_cast<std::int16_t>(k), static_cast<std::int16_t>(k + 1)});
      rising.push_back({static_cast<std::int16_t>(k), static_cast<std::int16_t>(-k), static_cast<std::int16_t>(1 - k)});
    }
    EXPECT_EQ(skeleton(Region::from_sorted(falling)), Region::from_sorted(falling));
    EXPECT_EQ(skeleton(Region::from_sorted(rising)), Region::from_sorted(rising));
  }
  const Region ring = difference(disc(30), disc(26));
  EXPECT_EQ(euler_number(skeleton(ring)), 0);
}

TEST(Skeleton, OfAVastSparseRegionNeedsLittle) {
  // The box has four billion pixels, of which a bit each would be 512 MiB.
  RunVector runs;
  for (int k = -32760; k < 32760; ++k)
    runs.push_back({static_cast<std::int16_t>(k), static_cast<std::int16_t>(k), static_cast<std::int16_t>(k + 3)});
  const Region line = Region::from_sorted(std::move(runs)), thin = skeleton(line);
  EXPECT_EQ(components(thin).size(), 1u);
  EXPECT_EQ(difference(thin, line), Region{});
  EXPECT_NEAR(static_cast<double>(area(thin)), 65520, 4);
  const Region corners =
      Region::from_runs({{-32768, -32768, -32765}, {-32768, 32760, 32767}, {32767, -32768, -32765}, {32767, 0, 1}});
  EXPECT_EQ(skeleton(corners), corners);
}

}  // namespace
}  // namespace tassilo
