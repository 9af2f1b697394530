#include "tassilo/source/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <span>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/files/jpeg.h"
#include "tassilo/files/png.h"
#include "tassilo/image/bt601.h"

namespace tassilo {
namespace {

using testing::HasSubstr;

RgbImage noise(int width, int height) {
  std::mt19937 random(1);
  RgbImage image{width, height, {}};
  for (int i = 0; i < 3 * width * height; ++i) image.pixels.push_back(static_cast<std::uint8_t>(random()));
  return image;
}
std::span<const std::uint8_t> bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
std::string refusal_of(const std::string& file, const PictureOptions& options = {.name = "image"}) {
  try {
    decode_picture(bytes(file), options);
  } catch (const Error& refusal) {
    return refusal.what();
  }
  return "";
}

TEST(DecodePicture, PngBecomesBt601InTheRangeAskedFor) {
  const RgbImage image = noise(13, 7);
  for (const ColorRange range : {ColorRange::limited, ColorRange::full}) {
    const Frame frame = decode_picture(bytes(encode_png(image)), {.name = "image", .images_range = range});
    const Frame expected = frame_from_rgb({image.pixels.data(), 13, 7, 39}, range);
    EXPECT_EQ(frame.range, range);
    for (int r = 0; r < 7; ++r)
      for (int c = 0; c < 13; ++c) {
        EXPECT_EQ(frame.view.y(c, r), expected.view.y(c, r));
        EXPECT_EQ(frame.view.u(c, r), expected.view.u(c, r));
        EXPECT_EQ(frame.view.v(c, r), expected.view.v(c, r));
      }
  }
}

TEST(DecodePicture, JpegIsFullRange) {
  const RgbImage image = noise(16, 8);
  const Frame frame = decode_picture(bytes(encode_jpeg(image.pixels, 16, 8, 90)), {.name = "image"});
  EXPECT_EQ(frame.range, ColorRange::full);
  EXPECT_EQ(frame.view.width(), 16);
  EXPECT_EQ(frame.view.height(), 8);
}

TEST(DecodePicture, RefusesWhatIsNoneCutOrTooLarge) {
  const RgbImage image = noise(64, 32);
  const std::string png = encode_png(image), jpeg = encode_jpeg(image.pixels, 64, 32, 90);
  EXPECT_THAT(refusal_of(""), HasSubstr("image: is empty, must be a PNG or JPEG image"));
  EXPECT_THAT(refusal_of("RIFF"), HasSubstr("is no PNG or JPEG image"));
  EXPECT_THAT(refusal_of(png.substr(0, png.size() / 2)), HasSubstr("is damaged or cut short"));
  EXPECT_THAT(refusal_of(jpeg.substr(0, jpeg.size() / 2)), HasSubstr("is cut short"));
  for (const std::string& file : {png, jpeg}) {
    EXPECT_EQ(refusal_of(file, {.name = "image", .max_pixels = 1 << 14}), "");
    EXPECT_NE(refusal_of(file, {.name = "image", .max_pixels = 1000}), "");
  }
}

TEST(DecodePicture, AnyBytesAreAPictureOrRefused) {
  const RgbImage image = noise(24, 16);
  std::mt19937 random(2);
  const std::string png = encode_png(image), jpeg = encode_jpeg(image.pixels, 24, 16, 80);
  for (int seed = 0; seed < 2000; ++seed) {
    std::string file = random() % 2 == 0 ? png : jpeg;
    for (std::uint32_t changes = 1 + random() % 4; changes > 0; --changes)
      file[random() % file.size()] = static_cast<char>(random());
    refusal_of(file, {.name = "image", .max_pixels = 1 << 16});
  }
}

}  // namespace
}  // namespace tassilo
