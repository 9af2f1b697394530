#include "tassilo/files/region_png.h"

#include <gtest/gtest.h>

#include "tassilo/files/internal/test_folder.h"
#include "tassilo/files/internal/test_message.h"
#include "tassilo/files/png.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/internal/test_regions.h"

namespace tassilo {
namespace {

TEST(RegionPng, WrittenRegionsReadBackEqual) {
  const TestFolder folder;
  for (unsigned seed = 0; seed < kRandomCases; seed += 7) {
    SCOPED_TRACE(seed);
    const auto [region, box] = random_case(seed);
    const Region moved = translated(region, {-box.x0, -box.y0});
    EXPECT_EQ(decode_png_region(encode_png_region(region, box), "a.png"), moved);
    write_png_region(folder / "mask.png", region, {box.x0 - 3, box.y0 - 2, box.x1, box.y1});
    EXPECT_EQ(read_png_region(folder / "mask.png"), translated(moved, {3, 2}));
    const GrayImage image = read_png_gray(folder / "mask.png");
    EXPECT_EQ(std::ranges::count(image.pixels, 255), area(region));
  }
}

TEST(RegionPng, AnyValueButZeroIsInside) {
  EXPECT_EQ(decode_png_region(encode_png(GrayImage{4, 1, {0, 1, 200, 0}}), "a.png"), Region::from_box({1, 0, 3, 1}));
}

TEST(RegionPng, RefusesWhatRegionsCannotHold) {
  const std::string wide = encode_png(GrayImage{32768, 1, std::vector<std::uint8_t>(32768, 1)});
  EXPECT_EQ(message_of([&] { decode_png_region(wide, "wide.png"); }),
            "wide.png: is a mask of 32768x1 pixels, must be at most 32767 wide and high");
  EXPECT_EQ(message_of([&] {
              decode_png_region(encode_png(RgbImage{1, 1, {1, 2, 3}}), "rgb.png");
            }),
            "rgb.png: is 8-bit RGB, must be 8-bit gray");
}

}  // namespace
}  // namespace tassilo
