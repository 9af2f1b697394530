#include "tassilo/region/morphology.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tassilo/base/kernel.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/test_regions.h"

namespace tassilo {
namespace {

std::vector<Region> elements() {
  return {rectangle(1, 1),
          rectangle(3, 3),
          rectangle(5, 1),
          rectangle(1, 6),
          rectangle(4, 2),
          disc(0),
          disc(1),
          disc(1.5),
          disc(3.5),
          disc(5),
          Region::from_runs({{0, 2, 3}}),                                       // one pixel beside the origin
          Region::from_runs({{-1, -2, 0}, {-1, 1, 2}, {0, 0, 1}, {2, -1, 3}}),  // with gaps, not symmetric
          Region::from_runs({{0, 0, 4}, {1, 0, 1}, {1, 3, 4}, {2, 0, 4}}),      // a ring
          Region::from_runs({{-2, 0, 1}, {-1, 0, 3}, {0, -4, 3}, {1, 0, 1}})};  // a bird
}

Region dilation_by_pixel(const Region& region, const Region& element) {
  std::vector<Region> moved;
  for (const PixelRun& run : element.runs())
    for (int c = run.begin; c < run.end; ++c) moved.push_back(translated(region, {c, run.row}));
  return union_of(moved);
}

Region erosion_by_pixel(const Region& region, const Region& element) {
  Region result;
  bool first = true;
  for (const PixelRun& run : element.runs())
    for (int c = run.begin; c < run.end; ++c) {
      const Region moved = translated(region, {-c, -run.row});
      result = first ? moved : intersection(result, moved);
      first = false;
    }
  return result;
}

TEST(Elements, AreCentred) {
  EXPECT_EQ(rectangle(3, 3), Region::from_box({-1, -1, 2, 2}));
  EXPECT_EQ(rectangle(4, 2), Region::from_box({-2, -1, 2, 1}));
  EXPECT_DEATH(rectangle(0, 3), "at least one pixel");
  EXPECT_DEATH(disc(-1), "not negative");
}

TEST(Elements, DiscHoldsThePixelCentresWithinItsRadius) {
  for (const double radius : {0., .5, 1., 1.5, 2., 3.5, 5., 7.5, 13., 25.}) {
    SCOPED_TRACE(radius);
    EXPECT_EQ(disc(radius),
              region_by_pixel({-30, -30, 31, 31}, [&](int c, int r) { return c * c + r * r <= radius * radius; }));
  }
}

TEST(Morphology, EqualsTheDefinition) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    const Region region = random_case(seed).region;
    for (std::size_t k = 0; k < elements().size(); ++k) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", element " << k);
      const Region element = elements()[k];
      EXPECT_EQ(dilation(region, element), dilation_by_pixel(region, element));
      EXPECT_EQ(erosion(region, element), erosion_by_pixel(region, element));
    }
  }
}

TEST(Morphology, DilationAndErosionAreDual) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    const auto [region, box] = random_case(seed);
    // So large that the domain's own border stays far from what is compared.
    const PixelBox domain{box.x0 - 30, box.y0 - 30, box.x1 + 30, box.y1 + 30};
    const PixelBox inner{box.x0 - 15, box.y0 - 15, box.x1 + 15, box.y1 + 15};
    for (std::size_t k = 0; k < elements().size(); ++k) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", element " << k);
      const Region element = elements()[k];
      EXPECT_EQ(complement(dilation(region, element), inner),
                clipped(erosion(complement(region, domain), reflected(element)), inner));
    }
  }
}

TEST(Morphology, OpeningAndClosingKeepTheirLaws) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    const Region region = random_case(seed).region;
    for (std::size_t k = 0; k < elements().size(); ++k) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", element " << k);
      const Region element = elements()[k];
      const Region opened = opening(region, element), closed = closing(region, element);
      EXPECT_EQ(opening(opened, element), opened);
      EXPECT_EQ(closing(closed, element), closed);
      EXPECT_TRUE(difference(opened, region).empty()) << "opening adds nothing";
      EXPECT_TRUE(difference(region, closed).empty()) << "closing loses nothing";
      EXPECT_EQ(opening(region, translated(element, {5, -3})), opened) << "the origin plays no part";
      EXPECT_EQ(closing(region, translated(element, {5, -3})), closed) << "the origin plays no part";
      EXPECT_EQ(opening(translated(region, {-9, 4}), element), translated(opened, {-9, 4}));
      EXPECT_EQ(closing(translated(region, {-9, 4}), element), translated(closed, {-9, 4}));
    }
  }
}

TEST(Morphology, OneBoxAfterAnotherIsTheirSum) {
  for (unsigned seed = 0; seed < kRandomCases; ++seed) {
    SCOPED_TRACE(seed);
    const Region region = random_case(seed).region;
    EXPECT_EQ(dilation(dilation(region, rectangle(3, 5)), rectangle(5, 3)), dilation(region, rectangle(7, 7)));
    EXPECT_EQ(erosion(erosion(region, rectangle(3, 1)), rectangle(1, 3)), erosion(region, rectangle(3, 3)));
  }
}

TEST(Morphology, OfNothingIsNothingAndByNothingIsBroken) {
  EXPECT_TRUE(dilation(Region{}, disc(3)).empty());
  EXPECT_TRUE(erosion(Region{}, disc(3)).empty());
  EXPECT_TRUE(closing(Region{}, rectangle(3, 3)).empty());
  EXPECT_DEATH(dilation(rectangle(3, 3), Region{}), "structuring element");
  EXPECT_DEATH(erosion(rectangle(3, 3), Region{}), "structuring element");
}

// A pixel far away makes the box around the region so large that runs are worth it, where planes were before.
TEST(Morphology, IsTheSameOnRunsAndOnBitPlanesForEveryKernel) {
  const Kernel before = kernel_in_use();
  const Region far_away = Region::from_box({20000, 9000, 20001, 9001});
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const int width = 1 + static_cast<int>(seed * 29 % 270), x = static_cast<int>(seed % 5) * 300 - 700;
    const PixelBox box{x, -20, x + width, -20 + 1 + static_cast<int>(seed % 37)};
    const double densities[] = {.5, .8, .95, .99};
    const Region region = random_region(seed, {box, densities[seed % 4], 0});
    for (const Region& element : elements()) {
      const Region both = union_of(region, far_away);
      const PixelBox near{-32000, -1000, 10000, 1000};
      const Region dilated = clipped(dilation(both, element), near), eroded = clipped(erosion(both, element), near);
      const Region opened = clipped(opening(both, element), near), closed = clipped(closing(both, element), near);
      for (const Kernel kernel : supported_kernels()) {
        SCOPED_TRACE(std::string(to_string(kernel)));
        use_kernel(kernel);
        ASSERT_EQ(dilation(region, element), dilated);
        ASSERT_EQ(erosion(region, element), eroded);
        ASSERT_EQ(opening(region, element), opened);
        ASSERT_EQ(closing(region, element), closed);
      }
      use_kernel(before);
    }
  }
}

// Planes are made and read in bands of 4096 words; here there are three.
TEST(Morphology, IsTheSameOnBitPlanesOfSeveralBands) {
  const Kernel before = kernel_in_use();
  const Region region = random_region(7, {{-300, 5, 400, 905}, .9, 0});
  const Region far_away = Region::from_box({20000, 9000, 20001, 9001});
  for (const Region& element : {rectangle(3, 3), disc(2.5)}) {
    const Region opened = difference(opening(union_of(region, far_away), element), far_away);
    for (const Kernel kernel : supported_kernels()) {
      SCOPED_TRACE(std::string(to_string(kernel)));
      use_kernel(kernel);
      EXPECT_EQ(opening(region, element), opened);
    }
    use_kernel(before);
  }
}

TEST(MorphologyDeathTest, LeavingSixteenBitStopsOnBitPlanesToo) {
  RunVector runs;
  for (int r = 0; r < 40; ++r)
    for (int c = 0; c < 40; c += 2)
      runs.push_back(
          {static_cast<std::int16_t>(r), static_cast<std::int16_t>(32700 + c), static_cast<std::int16_t>(32701 + c)});
  const Region region = Region::from_sorted(runs);
  EXPECT_DEATH(dilation(region, rectangle(99, 3)), "run coordinates stay within signed 16 bit");
}

}  // namespace
}  // namespace tassilo
