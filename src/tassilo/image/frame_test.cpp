#include "tassilo/image/frame.h"

#include <gtest/gtest.h>

#include <set>

namespace tassilo {
namespace {

constexpr PixelFormat kFormats[] = {PixelFormat::yuyv422, PixelFormat::uyvy422, PixelFormat::yuv422p,
                                    PixelFormat::yuv420p, PixelFormat::nv12};

// Every sample has a place of its own, and pixels that share chroma share exactly that.
TEST(FrameView, AddressesEachSampleOnce) {
  for (const PixelFormat format : kFormats)
    for (int width = 0; width < 9; ++width)
      for (int height = 0; height < 7; ++height) {
        SCOPED_TRACE(std::string(to_string(format)) + " " + std::to_string(width) + "x" + std::to_string(height));
        const FrameBuffer buffer = make_frame_buffer(format, width, height, ColorRange::full);
        const FrameView& view = buffer.frame.view;
        ASSERT_EQ(view.width(), width);
        ASSERT_EQ(view.height(), height);
        std::set<const std::uint8_t*> luma, chroma;
        for (int r = 0; r < height; ++r) {
          const YuvRow row = view.row(r);
          for (int c = 0; c < width; ++c) {
            luma.insert(row.y + c * row.y_step);
            chroma.insert(row.u + (c / 2) * row.chroma_step);
            chroma.insert(row.v + (c / 2) * row.chroma_step);
          }
        }
        const bool halved_rows = format == PixelFormat::yuv420p || format == PixelFormat::nv12;
        const int chroma_rows = halved_rows ? (height + 1) / 2 : height;
        EXPECT_EQ(luma.size(), static_cast<std::size_t>(width * height));
        EXPECT_EQ(chroma.size(), width == 0 ? 0u : static_cast<std::size_t>((width + 1) / 2 * chroma_rows * 2));
        for (const auto* p : chroma) EXPECT_FALSE(luma.contains(p));
      }
}

TEST(FrameView, ReadsWhatEachFormatMeans) {
  FrameBuffer yuyv = make_frame_buffer(PixelFormat::yuyv422, 4, 1, ColorRange::limited);
  const std::uint8_t bytes[] = {10, 100, 11, 200, 12, 101, 13, 201};
  std::copy(std::begin(bytes), std::end(bytes), yuyv.planes[0]);
  const FrameView& view = yuyv.frame.view;
  EXPECT_EQ(view.y(2, 0), 12);
  EXPECT_EQ(view.u(1, 0), 100);
  EXPECT_EQ(view.v(3, 0), 201);
}

}  // namespace
}  // namespace tassilo
