// Finds a red disc on a green floor: from an image in memory to regions and where the disc lies on the floor.
#include <cmath>
#include <cstdio>

#include "tassilo/camera/mount.h"
#include "tassilo/color/segment.h"
#include "tassilo/region/components.h"
#include "tassilo/region/region.h"

using namespace tassilo;

namespace {

struct YuvColor {
  std::uint8_t y, u, v;
};
constexpr YuvColor kGreen{90, 100, 90}, kRed{110, 90, 200};
constexpr int kWidth = 160, kHeight = 120;

/// Green everywhere, and a red disc. Two pixels side by side share one chroma sample, here that of the right one.
Frame draw_disc(double center_x, double center_y, double radius) {
  FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv422p, kWidth, kHeight, ColorRange::limited);
  for (int r = 0; r < kHeight; ++r) {
    for (int c = 0; c < kWidth; ++c) {
      const bool inside = std::hypot(c - center_x, r - center_y) <= radius;
      const YuvColor& color = inside ? kRed : kGreen;
      buffer.planes[0][r * buffer.strides[0] + c] = color.y;
      buffer.planes[1][r * buffer.strides[1] + c / 2] = color.u;
      buffer.planes[2][r * buffer.strides[2] + c / 2] = color.v;
    }
  }
  return buffer.frame;
}

/// A table by hand: what `tassilo train colors` makes from samples.
ColorTable two_colors() {
  ColorTable table;
  for (auto& interval : table.brightness) interval = {1, 0};  // empty, until a class has a color
  for (const auto& [color, yuv] : {std::pair{ColorClass::green, kGreen}, std::pair{ColorClass::red, kRed}}) {
    table.brightness[static_cast<std::size_t>(class_index(color))] = {yuv.y - 20, yuv.y + 20};
    for (int v = yuv.v - 10; v <= yuv.v + 10; ++v) {
      for (int u = yuv.u - 10; u <= yuv.u + 10; ++u) table.cell(u, v) |= class_bit(color);
    }
  }
  table.check();
  return table;
}

}  // namespace

int main() {
  const Frame frame = draw_disc(60, 70, 10);
  const Segmentation segmentation = segment(frame.view, Classifier(two_colors()));

  for (const ColorClass color : kColorClasses) {
    for (const Region& object : components(segmentation.of(color))) {
      const PixelBox box = bounding_box(object);
      std::printf("%s: area %lld px, box [%d, %d, %d, %d]\n", to_string(color).data(),
                  static_cast<long long>(area(object)), box.x0, box.y0, box.x1, box.y1);
    }
  }

  // The disc's lowest pixel, seen by a camera 0.5 m above the floor that looks 0.3 rad down.
  const CameraModel model{"example", kWidth, kHeight, 120, 120, 79.5, 59.5, PlumbBob{}};
  const MountedCamera camera(model, {.z = 0.5, .pitch = 0.3});
  const PixelBox box = bounding_box(segmentation.of(ColorClass::red));
  if (const auto point = camera.floor_point({60, static_cast<double>(box.y1 - 1)})) {
    std::printf("its foot is %.2f m ahead and %.2f m to the left\n", point->x, point->y);
  }
  return 0;
}
