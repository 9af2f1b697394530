#include "tassilo/image/sample.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace tassilo {
namespace {

// A plane through Y, U and V comes back exactly, chroma at the middle of the pixels that share it.
TEST(Sample, ReproducesPlanes) {
  for (const PixelFormat format :
       {PixelFormat::yuyv422, PixelFormat::yuv422p, PixelFormat::yuv420p, PixelFormat::nv12}) {
    SCOPED_TRACE(to_string(format));
    const int width = 16, height = 12;
    const FrameBuffer buffer = make_frame_buffer(format, width, height, ColorRange::full);
    const FrameView& view = buffer.frame.view;
    const int row_step = format == PixelFormat::yuv420p || format == PixelFormat::nv12 ? 2 : 1;
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c) {
        const YuvRow row = view.row(r);
        const_cast<std::uint8_t*>(row.y)[c * row.y_step] = static_cast<std::uint8_t>(10 + 5 * c + 3 * r);
        const_cast<std::uint8_t*>(row.u)[(c / 2) * row.chroma_step] = static_cast<std::uint8_t>(20 + 4 * (c / 2));
        const_cast<std::uint8_t*>(row.v)[(c / 2) * row.chroma_step] =
            static_cast<std::uint8_t>(30 + 6 * (r / row_step));
      }
    for (double r = 1; r <= 9; r += 0.37)
      for (double c = 1; c <= 13; c += 0.29) {
        const YuvValue value = sample(view, c, r);
        EXPECT_NEAR(value.y, 10 + 5 * c + 3 * r, 1e-9);
        EXPECT_NEAR(value.u, 20 + 4 * (c - 0.5) / 2, 1e-9);
        EXPECT_NEAR(value.v, row_step == 2 ? 30 + 6 * (r - 0.5) / 2 : 30 + 6 * r, 1e-9);
      }
    EXPECT_NEAR(sample(view, -5, -5).y, 10, 1e-9);
    EXPECT_NEAR(sample(view, 100, 100).y, 10 + 5 * 15 + 3 * 11, 1e-9);
  }
}

// Inside, across the border and outside, in every direction and layout.
TEST(SampleLine, EqualsSampleAtEachPlace) {
  std::mt19937 random(1);
  for (const PixelFormat format :
       {PixelFormat::yuyv422, PixelFormat::uyvy422, PixelFormat::yuv422p, PixelFormat::yuv420p, PixelFormat::nv12})
    for (const int width : {1, 16, 17}) {
      SCOPED_TRACE(testing::Message() << to_string(format) << ", " << width);
      const int height = 12;
      const FrameBuffer buffer = make_frame_buffer(format, width, height, ColorRange::full);
      const FrameView& view = buffer.frame.view;
      for (int r = 0; r < height; ++r) {
        const YuvRow row = view.row(r);
        for (int c = 0; c < width; ++c)
          for (const std::uint8_t* byte :
               {row.y + c * row.y_step, row.u + c / 2 * row.chroma_step, row.v + c / 2 * row.chroma_step})
            const_cast<std::uint8_t&>(*byte) = static_cast<std::uint8_t>(random());
      }
      std::uniform_real_distribution<double> column(-4, width + 4), row(-4, height + 4), step(-1, 1);
      for (int i = 0; i < 300; ++i) {
        const SampleLine line{column(random), row(random), step(random), step(random)};
        std::array<YuvValue, 9> values;
        sample_line(view, line, values);
        for (int k = 0; k < 9; ++k) {
          const YuvValue plain = sample(view, line.column + k * line.column_step, line.row + k * line.row_step);
          const YuvValue& fast = values[static_cast<std::size_t>(k)];
          EXPECT_TRUE(fast.y == plain.y && fast.u == plain.u && fast.v == plain.v) << i << ", " << k;
        }
      }
    }
}

TEST(Sample, OnePixelIsEverywhere) {
  const FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv420p, 1, 1, ColorRange::full);
  buffer.planes[0][0] = 77;
  EXPECT_DOUBLE_EQ(sample(buffer.frame.view, 3, -2).y, 77);
}

}  // namespace
}  // namespace tassilo
