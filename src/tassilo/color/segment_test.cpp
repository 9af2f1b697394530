#include "tassilo/color/segment.h"

#include <gtest/gtest.h>

#include <random>

namespace tassilo {
namespace {

/// Any bits anywhere and any intervals: nothing of it looks like a trained table.
ColorTable random_table(std::mt19937& random) {
  std::uniform_int_distribution<int> byte(0, 255);
  ColorTable table;
  for (ClassBits& bits : table.chroma) bits = static_cast<ClassBits>(byte(random) & byte(random));
  for (auto& interval : table.brightness) interval = {byte(random), byte(random)};
  std::ranges::shuffle(table.priority, random);
  return table;
}

Frame random_frame(PixelFormat format, int width, int height, std::mt19937& random) {
  FrameBuffer buffer = make_frame_buffer(format, width, height, ColorRange::full);
  std::uniform_int_distribution<int> byte(0, 255), few(0, 3);
  for (int r = 0; r < height; ++r) {
    const YuvRow row = buffer.frame.view.row(r);
    for (int c = 0; c < width; ++c) {
      const_cast<std::uint8_t*>(row.y)[c * row.y_step] = static_cast<std::uint8_t>(byte(random));
      const_cast<std::uint8_t*>(row.u)[(c / 2) * row.chroma_step] = static_cast<std::uint8_t>(100 + few(random));
      const_cast<std::uint8_t*>(row.v)[(c / 2) * row.chroma_step] = static_cast<std::uint8_t>(100 + few(random));
    }
  }
  return buffer.frame;
}

// The definition, pixel by pixel, for every format and every width up to a few words.
TEST(Segment, EqualsTheDefinitionForEveryFormatAndWidth) {
  std::mt19937 random(5);
  Segmentation recycled;
  for (const PixelFormat format :
       {PixelFormat::yuyv422, PixelFormat::uyvy422, PixelFormat::yuv422p, PixelFormat::yuv420p, PixelFormat::nv12})
    for (int width = 0; width <= 70; ++width) {
      SCOPED_TRACE(std::string(to_string(format)) + " width " + std::to_string(width));
      const ColorTable table = random_table(random);
      const Frame frame = random_frame(format, width, 5, random);
      recycled = segment(frame.view, Classifier(table), std::move(recycled));
      ASSERT_EQ(recycled.width, width);
      ASSERT_EQ(recycled.labels.size(), static_cast<std::size_t>(5 * width));
      for (int r = 0; r < 5; ++r)
        for (int c = 0; c < width; ++c) {
          const ColorClass expected = classify(table, frame.view.y(c, r), frame.view.u(c, r), frame.view.v(c, r));
          ASSERT_EQ(recycled.label(c, r), static_cast<int>(expected)) << c << ", " << r;
          for (const ColorClass color : kColorClasses)
            ASSERT_EQ(contains(recycled.of(color), c, r), color == expected) << to_string(color);
        }
      std::int64_t covered = std::ranges::count(recycled.labels, 0);
      for (const Region& region : recycled.regions) covered += area(region);
      ASSERT_EQ(covered, 5 * width);
    }
}

}  // namespace
}  // namespace tassilo
