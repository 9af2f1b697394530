#include "tassilo/files/png.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <random>

#include "tassilo/base/error.h"
#include "tassilo/files/test_folder.h"
#include "tassilo/files/text.h"

namespace tassilo {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

template <class Image>
Image random_image(int width, int height, int channels, unsigned seed) {
  std::mt19937 random(seed);
  Image image{width, height, {}};
  for (int i = 0; i < width * height * channels; ++i) image.pixels.push_back(static_cast<std::uint8_t>(random()));
  return image;
}

/// A PNG of any kind, written by libpng directly; rows are as libpng packs them.
std::string any_png(int width, int height, int depth, int type, const std::vector<std::uint8_t>& rows,
                    bool interlaced = false) {
  std::string out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp p, png_bytep data, std::size_t n) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(data), n);
      },
      nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), depth, type,
               interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  const png_color palette[] = {{10, 20, 30}, {40, 50, 60}, {70, 80, 90}, {1, 2, 3}};
  if (type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 4);
  png_write_info(png, info);
  const std::size_t row_bytes = png_get_rowbytes(png, info);
  std::vector<png_bytep> pointers;
  for (int r = 0; r < height; ++r)
    pointers.push_back(const_cast<png_bytep>(rows.data()) + row_bytes * static_cast<std::size_t>(r));
  png_write_image(png, pointers.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return out;
}

TEST(Png, WrittenImagesReadBackEqual) {
  const TestFolder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 7}, {64, 5}, {257, 31}}) {
    const auto gray = random_image<GrayImage>(width, height, 1, 1);
    write_png_gray(folder / "g.png", gray);
    EXPECT_EQ(read_png_gray(folder / "g.png"), gray);
    const auto rgb = random_image<RgbImage>(width, height, 3, 2);
    write_png_rgb(folder / "c.png", rgb);
    EXPECT_EQ(read_png_rgb(folder / "c.png"), rgb);
  }
}

TEST(Png, EveryKindBecomesRgb) {
  using Bytes = std::vector<std::uint8_t>;
  struct Case {
    const char* what;
    std::string png;
    Bytes rgb;
  };
  const Case cases[] = {
      {"1-bit gray", any_png(2, 1, 1, PNG_COLOR_TYPE_GRAY, {0b01000000}), {0, 0, 0, 255, 255, 255}},
      {"8-bit gray", any_png(2, 1, 8, PNG_COLOR_TYPE_GRAY, {7, 200}), {7, 7, 7, 200, 200, 200}},
      {"16-bit gray", any_png(2, 1, 16, PNG_COLOR_TYPE_GRAY, {0x80, 0xff, 0, 0}), {128, 128, 128, 0, 0, 0}},
      {"gray with alpha", any_png(1, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA, {9, 0}), {9, 9, 9}},
      {"palette", any_png(2, 1, 2, PNG_COLOR_TYPE_PALETTE, {0b01100000}), {40, 50, 60, 70, 80, 90}},
      {"RGB with alpha", any_png(1, 1, 8, PNG_COLOR_TYPE_RGBA, {1, 2, 3, 128}), {1, 2, 3}},
      {"16-bit RGB", any_png(1, 1, 16, PNG_COLOR_TYPE_RGB, {255, 255, 128, 0, 0, 0}), {255, 128, 0}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    EXPECT_EQ(decode_png_rgb(c.png, "a.png").pixels, c.rgb);
  }
  const auto image = random_image<RgbImage>(13, 11, 3, 3);
  EXPECT_EQ(decode_png_rgb(any_png(13, 11, 8, PNG_COLOR_TYPE_RGB, image.pixels, true), "interlaced"), image);
}

TEST(Png, LabelMapsMustBeEightBitGray) {
  const auto refused = [](const std::string& png, const std::string& kind) {
    EXPECT_THAT([&] { decode_png_gray(png, "a.png"); },
                ThrowsMessage<Error>("a.png: is " + kind + ", must be 8-bit gray"));
  };
  refused(any_png(1, 1, 8, PNG_COLOR_TYPE_RGB, {1, 2, 3}), "8-bit RGB");
  refused(any_png(1, 1, 1, PNG_COLOR_TYPE_GRAY, {0}), "1-bit gray");
  refused(any_png(1, 1, 16, PNG_COLOR_TYPE_GRAY, {0, 0}), "16-bit gray");
  refused(any_png(1, 1, 8, PNG_COLOR_TYPE_PALETTE, {0}), "8-bit palette");
  refused(any_png(1, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA, {0, 0}), "8-bit gray with transparency");
}

TEST(Png, BrokenDataIsRefused) {
  const std::string whole = encode_png(random_image<GrayImage>(40, 30, 1, 4));
  EXPECT_THAT([] { decode_png_gray("", "a.png"); }, ThrowsMessage<Error>("a.png: is no PNG file"));
  EXPECT_THAT([] { decode_png_rgb("GIF89a, surely", "a.png"); }, ThrowsMessage<Error>("a.png: is no PNG file"));
  for (std::size_t n = 8; n < whole.size(); n += 7)
    EXPECT_THAT([&] { decode_png_gray(whole.substr(0, n), "a.png"); },
                ThrowsMessage<Error>("a.png: is a broken PNG file: it ends too early"))
        << n;
  std::string flipped = whole;
  flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 1);
  EXPECT_THAT([&] { decode_png_gray(flipped, "a.png"); },
              ThrowsMessage<Error>(HasSubstr("a.png: is a broken PNG file: ")));
}

TEST(Png, HugeClaimsTakeNoMemory) {
  // Headers that claim 16384 x 16384 and 2^20 x 2^20 pixels, with nothing behind.
  const std::string large = any_png(16384, 1, 8, PNG_COLOR_TYPE_GRAY, std::vector<std::uint8_t>(16384));
  const auto claim = [&](std::uint32_t width, std::uint32_t height) {
    std::string header = large.substr(0, 33);
    const auto put = [&](std::size_t at, std::uint32_t value) {
      for (std::size_t i = 0; i < 4; ++i) header[at + i] = static_cast<char>(value >> (24 - 8 * i));
    };
    put(16, width);
    put(20, height);
    std::uint32_t crc = 0xffffffffu;
    for (std::size_t i = 12; i < 29; ++i) {
      crc ^= static_cast<std::uint8_t>(header[i]);
      for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? (crc >> 1) ^ 0xedb88320u : crc >> 1;
    }
    put(29, ~crc);
    return header + large.substr(33);
  };
  EXPECT_THAT([&] { decode_png_gray(claim(16384, 16384), "a.png"); },
              ThrowsMessage<Error>(HasSubstr("a.png: has 16384x16384 pixels in ")));
  EXPECT_THAT([&] { decode_png_gray(claim(1 << 20, 1 << 20), "a.png"); },
              ThrowsMessage<Error>("a.png: has 1048576x1048576 pixels, must have at most 268435456"));
  EXPECT_THAT([&] { decode_png_gray(claim(0xffffffffu, 1), "a.png"); },
              ThrowsMessage<Error>(HasSubstr("a.png: is a broken PNG file: ")));
}

}  // namespace
}  // namespace tassilo
