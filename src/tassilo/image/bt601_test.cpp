#include "tassilo/image/bt601.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace tassilo {
namespace {

TEST(Bt601, KnowsTheColorBars) {
  const Bt601 limited(ColorRange::limited);
  const RgbSum red{255, 0, 0}, blue{0, 0, 255}, white{255, 255, 255};
  EXPECT_EQ(limited.y(white), 235);
  EXPECT_EQ(limited.cb(white, 1), 128);
  EXPECT_EQ(limited.y(red), 81);
  EXPECT_EQ(limited.cb(red, 1), 90);
  EXPECT_EQ(limited.cr(red, 1), 240);
  EXPECT_EQ(limited.cb(blue, 1), 240);
  const Bt601 full(ColorRange::full);
  EXPECT_EQ(full.y(white), 255);
  EXPECT_EQ(full.y(red), 76);
  EXPECT_EQ(full.cr(red, 1), 255);
}

TEST(Bt601, IsTheFormulaRounded) {
  for (const ColorRange range : {ColorRange::limited, ColorRange::full})
    for (int r = 0; r < 256; r += 15)
      for (int g = 0; g < 256; g += 17)
        for (int b = 0; b < 256; b += 51) {
          const Bt601 bt601(range);
          const double y = .299 * r + .587 * g + .114 * b, luma = range == ColorRange::full ? 1 : 219.0 / 255,
                       chroma = range == ColorRange::full ? 1 : 224.0 / 255,
                       offset = range == ColorRange::full ? 0 : 16;
          EXPECT_NEAR(bt601.y({r, g, b}), offset + luma * y, 0.5 + 1e-9);
          EXPECT_NEAR(bt601.cb({r, g, b}, 1), 128 + chroma * (b - y) / 1.772, 0.5 + 1e-9);
          EXPECT_EQ(bt601.cr({r, g, b}, 1), bt601.cr({2 * r, 2 * g, 2 * b}, 2)) << "the mean of equal pixels";
        }
}

TEST(FrameFromRgb, AveragesChromaOverPairsAndKnowsStridesAndOddWidths) {
  // Two rows of three pixels and two bytes of padding: blue and yellow average to gray, red stands alone.
  const std::vector<std::uint8_t> bytes{0,   0, 255, 255, 255, 0, 255, 0, 0, 9, 9,  //
                                        255, 0, 0,   255, 0,   0, 0,   0, 0, 9, 9};
  const Frame frame = frame_from_rgb({bytes.data(), 3, 2, 11}, ColorRange::limited);
  EXPECT_EQ(frame.view.width(), 3);
  EXPECT_EQ(frame.view.height(), 2);
  EXPECT_EQ(frame.range, ColorRange::limited);
  EXPECT_EQ(frame.view.u(0, 0), 128);
  EXPECT_EQ(frame.view.v(1, 0), 128);
  EXPECT_EQ(frame.view.v(2, 0), 240);
  EXPECT_EQ(frame.view.y(2, 0), 81);
  EXPECT_EQ(frame.view.v(0, 1), 240);
  EXPECT_EQ(frame.view.y(2, 1), 16);
}

/// Plain, value by value.
Frame plain(const RgbView& picture, ColorRange range) {
  FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv422p, picture.width, picture.height, range);
  const std::size_t red = picture.is_bgr ? 2 : 0;
  for (int r = 0; r < picture.height; ++r)
    fill_row_from_rgb(buffer, r, Bt601(range), [&](int c) {
      const std::uint8_t* const pixel = picture.data + r * picture.stride + 3 * static_cast<std::ptrdiff_t>(c);
      return RgbSum{pixel[red], pixel[1], pixel[2 - red]};
    });
  return std::move(buffer.frame);
}

void expect_equal(const Frame& one, const Frame& other) {
  int different = 0;
  for (int r = 0; r < one.view.height(); ++r)
    for (int c = 0; c < one.view.width(); ++c)
      different += one.view.y(c, r) != other.view.y(c, r) || one.view.u(c, r) != other.view.u(c, r) ||
                   one.view.v(c, r) != other.view.v(c, r);
  EXPECT_EQ(different, 0);
}

TEST(FrameFromRgb, IsThePlainConversionForEveryWidthAndOrder) {
  std::mt19937 random(1);
  std::vector<std::uint8_t> bytes(70 * 3 * 4);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  for (const ColorRange range : {ColorRange::limited, ColorRange::full})
    for (int width = 0; width <= 66; ++width)
      for (const bool is_bgr : {false, true}) {
        SCOPED_TRACE(width);
        const RgbView picture{bytes.data(), width, 3, 3 * width + 5, is_bgr};
        expect_equal(frame_from_rgb(picture, range), plain(picture, range));
      }
}

TEST(FrameFromRgb, IsThePlainConversionForColorsAllOver) {
  // Each third value with both ends; rows of one pixel, so that chroma is that of one color, and of pairs.
  std::vector<std::uint8_t> bytes;
  for (int r = 0; r < 256; r += 3)
    for (int g = 0; g < 256; g += 3)
      for (int b = 0; b < 256; b += 3)
        for (const int value : {r, g, b}) bytes.push_back(static_cast<std::uint8_t>(value));
  const int colors = static_cast<int>(bytes.size() / 3);
  for (const ColorRange range : {ColorRange::limited, ColorRange::full}) {
    const RgbView single{bytes.data(), 1, colors, 3}, pairs{bytes.data(), 2, colors / 2, 6};
    expect_equal(frame_from_rgb(single, range), plain(single, range));
    expect_equal(frame_from_rgb(pairs, range), plain(pairs, range));
  }
}

}  // namespace
}  // namespace tassilo
