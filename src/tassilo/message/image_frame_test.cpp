#include "tassilo/message/image_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tassilo/image/bt601.h"
#include "tassilo/message/codec.h"

namespace tassilo {
namespace {

using testing::HasSubstr;

/// Y, U and V of each pixel, as the encoding says where they lie.
struct Pixel {
  int y = 0, u = 0, v = 0;
  friend bool operator==(const Pixel&, const Pixel&) = default;
};

struct Layout {
  const char* encoding;
  PixelFormat format;
  std::uint32_t row_bytes(std::uint32_t width) const {
    const std::uint32_t pairs = (width + 1) / 2;
    if (format == PixelFormat::nv12) return 2 * pairs;
    return format == PixelFormat::yuv422p ? 3 * width : 4 * pairs;
  }
  std::uint32_t rows(std::uint32_t height) const {
    return format == PixelFormat::nv12 ? height + (height + 1) / 2 : height;
  }
};
constexpr Layout kLayouts[] = {{"uyvy", PixelFormat::uyvy422}, {"yuv422", PixelFormat::uyvy422},
                               {"yuyv", PixelFormat::yuyv422}, {"yuv422_yuy2", PixelFormat::yuyv422},
                               {"nv12", PixelFormat::nv12},    {"rgb8", PixelFormat::yuv422p},
                               {"bgr8", PixelFormat::yuv422p}};

ros::Image random_image(const Layout& layout, std::uint32_t width, std::uint32_t height, std::uint32_t padding,
                        std::mt19937& random) {
  ros::Image image;
  image.header.stamp = {1'700'000'000, 5};
  image.header.frame_id = "camera";
  image.width = width;
  image.height = height;
  image.encoding = layout.encoding;
  image.step = layout.row_bytes(width) + padding;
  image.data.resize(std::size_t{image.step} * layout.rows(height));
  for (std::uint8_t& byte : image.data) byte = static_cast<std::uint8_t>(random());
  return image;
}

ros::BorrowedImage borrowed(const ros::Image& image) {
  return {image.header, image.height, image.width, image.encoding, image.is_bigendian, image.step, image.data};
}
Frame frame_of(const ros::Image& image, const ImageRanges& ranges = {}) {
  return frame_from(borrowed(image), ranges, nullptr);
}

Pixel yuv_in(const ros::Image& image, const Layout& layout, std::size_t c, std::size_t r) {
  const std::uint8_t* const row = image.data.data() + r * image.step;
  const std::size_t pair = c / 2;
  if (layout.format == PixelFormat::uyvy422) return {row[2 * c + 1], row[4 * pair], row[4 * pair + 2]};
  if (layout.format == PixelFormat::yuyv422) return {row[2 * c], row[4 * pair + 1], row[4 * pair + 3]};
  const std::uint8_t* const chroma = image.data.data() + (image.height + r / 2) * image.step;
  return {row[c], chroma[2 * pair], chroma[2 * pair + 1]};
}

TEST(FrameFromImage, HasThePixelsOfTheMessageInEveryEncoding) {
  std::mt19937 random(1);
  for (const Layout& layout : kLayouts)
    for (std::uint32_t width = 1; width <= 9; ++width)
      for (const std::uint32_t height : {1U, 2U, 3U, 6U})
        for (const std::uint32_t padding : {0U, 1U, 5U}) {
          SCOPED_TRACE(testing::Message() << layout.encoding << " " << width << "x" << height << " +" << padding);
          const ros::Image image = random_image(layout, width, height, padding, random);
          for (const ColorRange range : {ColorRange::limited, ColorRange::full}) {
            const Frame frame = frame_of(image, {range, range});
            EXPECT_EQ(frame.view.format(), layout.format);
            EXPECT_EQ(frame.range, range);
            ASSERT_EQ(frame.view.width(), static_cast<int>(width));
            ASSERT_EQ(frame.view.height(), static_cast<int>(height));
            const Bt601 bt601(range);
            for (std::uint32_t r = 0; r < height; ++r)
              for (std::uint32_t c = 0; c < width; ++c) {
                const int column = static_cast<int>(c), row = static_cast<int>(r);
                const Pixel seen{frame.view.y(column, row), frame.view.u(column, row), frame.view.v(column, row)};
                if (layout.format != PixelFormat::yuv422p) {
                  EXPECT_EQ(seen, yuv_in(image, layout, c, r));
                  continue;
                }
                const std::uint8_t* const p = image.data.data() + r * image.step + 3 * std::size_t{c};
                const bool is_rgb = std::string(layout.encoding) == "rgb8";
                EXPECT_EQ(seen.y, bt601.y({is_rgb ? p[0] : p[2], p[1], is_rgb ? p[2] : p[0]}));
              }
          }
        }
}

TEST(FrameFromImage, RgbAndBgrAreTheSamePictureAsFromAFile) {
  std::mt19937 random(2);
  ros::Image rgb = random_image(kLayouts[5], 13, 7, 2, random);
  const Frame expected = frame_from_rgb({rgb.data.data(), 13, 7, rgb.step}, ColorRange::limited);
  ros::Image bgr = rgb;
  bgr.encoding = "bgr8";
  for (std::size_t r = 0; r < 7; ++r)
    for (std::size_t c = 0; c < 13; ++c) std::swap(bgr.data[r * bgr.step + 3 * c], bgr.data[r * bgr.step + 3 * c + 2]);
  for (const ros::Image& image : {rgb, bgr}) {
    const Frame frame = frame_of(image);
    for (int r = 0; r < 7; ++r)
      for (int c = 0; c < 13; ++c) {
        EXPECT_EQ(frame.view.y(c, r), expected.view.y(c, r));
        EXPECT_EQ(frame.view.u(c, r), expected.view.u(c, r));
        EXPECT_EQ(frame.view.v(c, r), expected.view.v(c, r));
      }
  }
}

TEST(FrameFromImage, PixelsAreTheBytesOfTheMessage) {
  std::mt19937 random(3);
  const ros::Image image = random_image(kLayouts[0], 8, 4, 0, random);
  const auto bytes = std::make_shared<const std::vector<std::byte>>(encoded(image));
  Frame frame;
  {
    const auto message = decoded<ros::BorrowedImage>(*bytes);
    ASSERT_TRUE(message);
    EXPECT_EQ(message->header.frame_id, "camera");
    EXPECT_EQ(std::vector<std::uint8_t>(message->data.begin(), message->data.end()), image.data);
    frame = frame_from(*message, {}, bytes);
  }
  EXPECT_EQ(bytes.use_count(), 2);
  const auto* const first = reinterpret_cast<const std::byte*>(frame.view.row(0).u);
  EXPECT_GE(first, bytes->data());
  EXPECT_LT(first, bytes->data() + bytes->size());
}

/// What is said of an image that is refused.
std::string refusal_of(const ros::Image& image) {
  try {
    frame_of(image);
  } catch (const UnknownEncoding& unknown) {
    return std::string("unknown ") + unknown.what();
  } catch (const Error& refusal) {
    return refusal.what();
  }
  return "";
}

TEST(FrameFromImage, RefusesWhatDoesNotBelongTogether) {
  std::mt19937 random(4);
  for (const Layout& layout : kLayouts) {
    SCOPED_TRACE(layout.encoding);
    const ros::Image good = random_image(layout, 6, 4, 1, random);
    EXPECT_EQ(refusal_of(good), "");
    ros::Image bad = good;
    bad.width = 0;
    EXPECT_THAT(refusal_of(bad), HasSubstr("is 0x4 px, must be 1..32767 in both directions"));
    bad = good;
    bad.height = 40'000;
    EXPECT_THAT(refusal_of(bad), HasSubstr("is 6x40000 px"));
    bad = good;
    bad.step = layout.row_bytes(6) - 1;
    EXPECT_THAT(refusal_of(bad), HasSubstr("must be at least " + std::to_string(layout.row_bytes(6))));
    bad = good;
    bad.step = 0xffffffff;
    EXPECT_THAT(refusal_of(bad), HasSubstr("must have " + std::to_string(0xffffffffULL * layout.rows(4))));
    for (const int change : {-1, 1}) {
      bad = good;
      bad.data.resize(good.data.size() + static_cast<std::size_t>(change));
      EXPECT_THAT(refusal_of(bad), HasSubstr("must have " + std::to_string(good.data.size()) + ": "));
    }
  }
  // An odd width has a whole pair at its end.
  ros::Image odd = random_image(kLayouts[0], 3, 1, 0, random);
  odd.step = 6;
  odd.data.resize(6);
  EXPECT_THAT(refusal_of(odd), HasSubstr("step of 6 bytes, must be at least 8 for 3 px of uyvy"));
}

TEST(FrameFromImage, NamesEncodingsThatAreNotKnown) {
  std::mt19937 random(5);
  ros::Image image = random_image(kLayouts[0], 4, 4, 0, random);
  for (const char* const encoding : {"", "mono8", "nv21", "bayer_rggb8", "rgba8", "UYVY"}) {
    image.encoding = encoding;
    EXPECT_THAT(refusal_of(image), HasSubstr(std::string("unknown encoding: is ") + encoding + ", must be uyvy"));
  }
  image.encoding = "\33[2J" + std::string(1000, 'x');
  EXPECT_THAT(refusal_of(image), HasSubstr("is ?[2Jxxx"));
  EXPECT_LT(refusal_of(image).size(), 250U);
}

TEST(FrameFromImage, AnyBytesAreAFrameOrRefused) {
  std::mt19937 random(6);
  int frames = 0;
  for (int seed = 0; seed < 20'000; ++seed) {
    const Layout& layout = kLayouts[random() % std::size(kLayouts)];
    std::vector<std::byte> bytes =
        encoded(random_image(layout, 1 + random() % 8, 1 + random() % 4, random() % 3, random));
    for (std::uint32_t changes = random() % 4; changes > 0; --changes)
      bytes[random() % bytes.size()] = static_cast<std::byte>(random());
    if (random() % 8 == 0) bytes.resize(random() % bytes.size());
    const auto message = decoded<ros::BorrowedImage>(bytes);
    if (!message) continue;
    try {
      const Frame frame = frame_from(*message, {}, nullptr);
      ++frames;
      int sum = 0;
      for (int r = 0; r < frame.view.height(); ++r)
        for (int c = 0; c < frame.view.width(); ++c)
          sum += frame.view.y(c, r) + frame.view.u(c, r) + frame.view.v(c, r);
      EXPECT_GE(sum, 0);
    } catch (const Error&) {
    }
  }
  EXPECT_GT(frames, 1000);
}

}  // namespace
}  // namespace tassilo
