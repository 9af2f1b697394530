#include "tassilo/app/frame_bytes.h"

#include <gtest/gtest.h>

#include <random>

namespace tassilo {
namespace {

// Every format, odd sizes, too: what comes back has the same samples at every pixel.
TEST(FrameBytes, HaveThePixelsOfTheFrame) {
  std::mt19937 random(1);
  for (const PixelFormat format :
       {PixelFormat::yuyv422, PixelFormat::uyvy422, PixelFormat::yuv422p, PixelFormat::yuv420p, PixelFormat::nv12})
    for (const int width : {1, 2, 7, 16})
      for (const int height : {1, 5, 6}) {
        FrameBuffer buffer = make_frame_buffer(format, width, height, ColorRange::full);
        // All that belongs to the frame lies behind its first plane.
        const bool is_subsampled = format == PixelFormat::yuv420p || format == PixelFormat::nv12;
        const int chroma = (width + 1) / 2 * (is_subsampled ? (height + 1) / 2 : height);
        const bool is_packed = format == PixelFormat::yuyv422 || format == PixelFormat::uyvy422;
        const int size = is_packed ? 4 * ((width + 1) / 2) * height : width * height + 2 * chroma;
        for (int i = 0; i < size; ++i) buffer.planes[0][i] = static_cast<std::uint8_t>(random());
        buffer.frame.index = 1'000'000'000'000;
        buffer.frame.t = 1.0 / 3;
        const Frame back = frame_of_bytes(std::make_shared<const std::string>(frame_bytes(buffer.frame)));
        EXPECT_EQ(back.range, ColorRange::full);
        EXPECT_EQ(back.index, buffer.frame.index);
        EXPECT_EQ(back.t, buffer.frame.t);
        ASSERT_EQ(back.view.width(), width);
        ASSERT_EQ(back.view.height(), height);
        for (int r = 0; r < height; ++r)
          for (int c = 0; c < width; ++c) {
            ASSERT_EQ(back.view.y(c, r), buffer.frame.view.y(c, r));
            ASSERT_EQ(back.view.u(c, r), buffer.frame.view.u(c, r));
            ASSERT_EQ(back.view.v(c, r), buffer.frame.view.v(c, r));
          }
      }
}

}  // namespace
}  // namespace tassilo
