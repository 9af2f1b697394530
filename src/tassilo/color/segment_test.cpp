#include "tassilo/color/segment.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>

#include "tassilo/base/kernel.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/raster.h"

namespace tassilo {
namespace {

constexpr std::array kFormats{PixelFormat::yuyv422, PixelFormat::uyvy422, PixelFormat::yuv422p, PixelFormat::yuv420p,
                              PixelFormat::nv12};

/// Every kernel that this machine runs, each in its turn; the one before afterwards.
template <class Body>
void for_each_kernel(Body body) {
  const Kernel before = kernel_in_use();
  for (const Kernel kernel : supported_kernels()) {
    SCOPED_TRACE(std::string("kernel ") + std::string(to_string(kernel)));
    use_kernel(kernel);
    body();
  }
  use_kernel(before);
}

/// Any bits anywhere and any intervals: nothing of it looks like a trained table, and no kernel can cut it in strips.
ColorTable random_table(std::mt19937& random) {
  std::uniform_int_distribution<int> byte(0, 255);
  ColorTable table;
  for (ClassBits& bits : table.chroma) bits = static_cast<ClassBits>(byte(random) & byte(random));
  for (auto& interval : table.brightness) interval = {byte(random), byte(random)};
  std::ranges::shuffle(table.priority, random);
  return table;
}

/// Ragged blobs of every class, as hand-trained tables have them; whole rows, and both ends of the byte, too.
ColorTable ragged_table(std::mt19937& random) {
  ColorTable table;
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (const ColorClass color : kColorClasses) {
    table.brightness[static_cast<std::size_t>(class_index(color))] = {below(200), 55 + below(201)};
    const int u0 = below(256), v0 = below(256), height = 1 + below(90);
    for (int v = v0; v < std::min(256, v0 + height); ++v)
      for (int u = std::max(0, u0 - below(30)); u < std::min(256, u0 + below(30)); ++u)
        table.cell(u, v) |= class_bit(color);
  }
  for (int u = 0; u < 256; ++u) table.cell(u, 77) |= class_bit(ColorClass::green);
  std::ranges::shuffle(table.priority, random);
  return table;
}

/// Bytes of any value, or near the middle of the chroma plane where most of a table lies; strides with a gap.
Frame random_frame(PixelFormat format, int width, int height, std::mt19937& random) {
  FrameBuffer buffer = make_frame_buffer(format, width, height, ColorRange::full);
  const bool anywhere = random() % 2 == 0;
  for (int r = 0; r < height; ++r) {
    const YuvRow row = buffer.frame.view.row(r);
    for (int c = 0; c < width; ++c) {
      const_cast<std::uint8_t*>(row.y)[c * row.y_step] = static_cast<std::uint8_t>(random());
      const auto chroma = [&] { return static_cast<std::uint8_t>(anywhere ? random() : 100 + random() % 4); };
      const_cast<std::uint8_t*>(row.u)[(c / 2) * row.chroma_step] = chroma();
      const_cast<std::uint8_t*>(row.v)[(c / 2) * row.chroma_step] = chroma();
    }
  }
  return buffer.frame;
}

/// Blocks of one color each and single odd pixels: something is left when it is opened.
Frame blotted_frame(PixelFormat format, int width, int height, std::mt19937& random) {
  const Frame frame = random_frame(format, width, height, random);
  const unsigned seed = random();
  for (int r = 0; r < height; ++r) {
    const YuvRow row = frame.view.row(r);
    for (int c = 0; c < width; ++c) {
      if (random() % 25 == 0) continue;
      std::mt19937 of_block(seed + static_cast<unsigned>(c / 14 + 100 * (r / 6)));
      const_cast<std::uint8_t*>(row.y)[c * row.y_step] = static_cast<std::uint8_t>(of_block());
      const_cast<std::uint8_t*>(row.u)[(c / 2) * row.chroma_step] = static_cast<std::uint8_t>(100 + of_block() % 40);
      const_cast<std::uint8_t*>(row.v)[(c / 2) * row.chroma_step] = static_cast<std::uint8_t>(60 + of_block() % 40);
    }
  }
  return frame;
}

void expect_definition(const FrameView& frame, const ColorTable& table, const Segmentation& found) {
  ASSERT_EQ(found.width, frame.width());
  ASSERT_EQ(found.height, frame.height());
  ASSERT_EQ(found.labels.size(), static_cast<std::size_t>(frame.width() * frame.height()));
  for (int r = 0; r < frame.height(); ++r)
    for (int c = 0; c < frame.width(); ++c) {
      const ColorClass expected = classify(table, frame.y(c, r), frame.u(c, r), frame.v(c, r));
      ASSERT_EQ(found.label(c, r), static_cast<int>(expected)) << c << ", " << r;
    }
  const ByteView labels{found.labels.data(), found.width, found.height, found.width};
  const std::vector<Region> by_label = regions_of_labels(labels, kColorClassCount + 1);
  for (const ColorClass color : kColorClasses)
    ASSERT_EQ(found.of(color), by_label[static_cast<std::size_t>(color)]) << to_string(color);
}

// The definition, pixel by pixel, for every kernel, format and width up to a few vectors.
TEST(Segment, EqualsTheDefinitionForEveryKernelFormatAndWidth) {
  for_each_kernel([] {
    std::mt19937 random(5);
    Segmentation recycled;
    for (const PixelFormat format : kFormats)
      for (int width = 0; width <= 300; ++width) {
        SCOPED_TRACE(std::string(to_string(format)) + " width " + std::to_string(width));
        const ColorTable table = width % 4 == 3 ? random_table(random) : ragged_table(random);
        const Frame frame = random_frame(format, width, 3, random);
        recycled = segment(frame.view, Classifier(table), std::move(recycled));
        expect_definition(frame.view, table, recycled);
        if (testing::Test::HasFatalFailure()) return;
      }
  });
}

// Rows that lie in a larger image: no byte beside the row plays a part, as strides are odd and the bytes between
// differ.
TEST(Segment, KnowsOddStridesAndNeighbors) {
  for_each_kernel([] {
    std::mt19937 random(7);
    for (const PixelFormat format : kFormats)
      for (const int width : {1, 2, 63, 64, 65, 128, 131, 200}) {
        SCOPED_TRACE(std::string(to_string(format)) + " width " + std::to_string(width));
        const int height = 4;
        const std::ptrdiff_t stride = 4 * ((width + 1) / 2) + 3;
        std::vector<std::uint8_t> bytes(static_cast<std::size_t>(3 * stride * height));
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
        const std::uint8_t* plane = bytes.data();
        const bool packed = format == PixelFormat::yuyv422 || format == PixelFormat::uyvy422;
        const FrameView frame = packed
                                    ? FrameView::packed(format, width, height, plane, stride)
                                    : FrameView::planar(format, width, height,
                                                        {plane, plane + stride * height, plane + 2 * stride * height},
                                                        {stride, stride, stride});
        const ColorTable table = ragged_table(random);
        expect_definition(frame, table, segment(frame, Classifier(table)));
        if (testing::Test::HasFatalFailure()) return;
      }
  });
}

// A frame whose rows share U but not V, as a broadcast array has them.
TEST(Segment, LooksAtBothChromaRows) {
  for_each_kernel([] {
    std::mt19937 random(11);
    const int width = 200, height = 4;
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(3 * width * height));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    const std::uint8_t* plane = bytes.data();
    const FrameView frame =
        FrameView::planar(PixelFormat::yuv422p, width, height,
                          {plane, plane + width * height, plane + 2 * width * height}, {width, 0, width});
    const ColorTable table = random_table(random);
    expect_definition(frame, table, segment(frame, Classifier(table)));
  });
}

// Pixel noise in stripes of two classes: as many runs as fit.
TEST(Segment, HoldsAsManyRunsAsThereCanBe) {
  for_each_kernel([] {
    ColorTable table;
    table.chroma.fill(class_bit(ColorClass::white) | class_bit(ColorClass::black));
    table.brightness[static_cast<std::size_t>(class_index(ColorClass::black))] = {0, 99};
    table.brightness[static_cast<std::size_t>(class_index(ColorClass::white))] = {100, 255};
    const int width = 1001, height = 300;
    FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv420p, width, height, ColorRange::full);
    for (std::ptrdiff_t i = 0; i < std::ptrdiff_t{width} * height; ++i)
      buffer.planes[0][i] = i % width % 2 == 0 ? 0 : 200;
    const Segmentation found = segment(buffer.frame.view, Classifier(table));
    EXPECT_EQ(found.of(ColorClass::black).runs().size(), 501u * 300u);
    EXPECT_EQ(found.of(ColorClass::white).runs().size(), 500u * 300u);
    expect_definition(buffer.frame.view, table, found);
  });
}

TEST(SegmentOpened, IsTheOpeningOfTheSegmentation) {
  for_each_kernel([] {
    std::mt19937 random(9);
    Segmentation recycled;
    std::int64_t left = 0;
    for (int width = 0; width <= 200; ++width) {
      SCOPED_TRACE(width);
      const PixelFormat format = kFormats[static_cast<std::size_t>(width) % kFormats.size()];
      const Classifier classifier(ragged_table(random));
      const Frame frame = blotted_frame(format, width, static_cast<int>(random() % 14), random);
      recycled = segment_opened(frame.view, classifier, std::move(recycled));
      const Segmentation expected = opening3x3(segment(frame.view, classifier));
      ASSERT_EQ(recycled.labels, expected.labels);
      ASSERT_EQ(recycled.regions, expected.regions);
      for (const Region& region : expected.regions) left += area(region);
    }
    EXPECT_GT(left, 3000);
  });
}

// All at once is each for itself.
TEST(Opening3x3, OpensEveryRegion) {
  for_each_kernel([] {
    std::mt19937 random(3);
    Segmentation recycled;
    for (int width = 0; width <= 200; ++width) {
      SCOPED_TRACE(width);
      Segmentation labels;
      labels.width = width;
      labels.height = static_cast<int>(random() % 14);
      // Columns of a few labels with a little noise: there must be something left to dilate.
      labels.labels.resize(static_cast<std::size_t>(labels.width * labels.height));
      for (std::size_t i = 0; i < labels.labels.size(); ++i) {
        const auto column = static_cast<unsigned>(i) % static_cast<unsigned>(width);
        labels.labels[i] =
            static_cast<std::uint8_t>(random() % 20 == 0 ? random() % 9 : column / (3 + random() % 2) % 9);
      }
      recycled = opening3x3(labels, std::move(recycled));
      const ByteView view{labels.labels.data(), width, labels.height, width};
      const std::vector<Region> before = regions_of_labels(view, kColorClassCount + 1);
      for (const ColorClass color : kColorClasses)
        ASSERT_EQ(recycled.of(color), opening(before[static_cast<std::size_t>(color)], rectangle(3, 3)))
            << to_string(color);
      const ByteView opened{recycled.labels.data(), width, labels.height, width};
      const std::vector<Region> after = regions_of_labels(opened, kColorClassCount + 1);
      for (const ColorClass color : kColorClasses)
        ASSERT_EQ(recycled.of(color), after[static_cast<std::size_t>(color)]) << to_string(color);
    }
  });
}

}  // namespace
}  // namespace tassilo
