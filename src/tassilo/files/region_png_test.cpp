#include "tassilo/files/region_png.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tassilo/files/internal/test_mask.h"
#include "tassilo/files/internal/test_message.h"
#include "tassilo/files/png.h"
#include "tassilo/files/test_folder.h"
#include "tassilo/region/algebra.h"

namespace tassilo {
namespace {

TEST(RegionPng, WrittenRegionsReadBackEqual) {
  const TestFolder folder;
  for (unsigned seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    const auto [width, height, region] = random_mask(seed);
    EXPECT_EQ(decode_png_region(encode_png_region(region, {0, 0, width, height}), "a.png"), region);
    // A window that moves the mask, and one that cuts it.
    write_png_region(folder / "mask.png", region, {-3, -2, width, height});
    EXPECT_EQ(read_png_region(folder / "mask.png"), translated(region, {3, 2}));
    write_png_region(folder / "mask.png", translated(region, {-1, 0}), {0, 0, width, height});
    const GrayImage image = read_png_gray(folder / "mask.png");
    EXPECT_EQ(std::ranges::count(image.pixels, 255), area(clipped(region, {1, 0, width, height})));
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
