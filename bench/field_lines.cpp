#include "field_lines.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <utility>

#include "support/recording.h"
#include "tassilo/color/segment.h"
#include "tassilo/region/raster.h"

namespace tassilo::bench {
namespace {

/// How far a floor point is from the middle of the nearest line of a 9 m x 6 m field, whose lines are all alike. [m]
double distance_to_lines(double x, double y) {
  const auto to_segment = [&](double x0, double y0, double x1, double y1) {
    return std::hypot(x - std::clamp(x, std::min(x0, x1), std::max(x0, x1)),
                      y - std::clamp(y, std::min(y0, y1), std::max(y0, y1)));
  };
  double nearest = std::abs(std::hypot(x, y) - .75);
  nearest = std::min(nearest, to_segment(0, -3, 0, 3));
  for (const double side : {-1., 1.}) {
    nearest = std::min(nearest, to_segment(-4.5, side * 3, 4.5, side * 3));
    nearest = std::min(nearest, to_segment(side * 4.5, -3, side * 4.5, 3));
    nearest = std::min(nearest, to_segment(side * 3.5, -1.5, side * 3.5, 1.5));
    for (const double end : {-1.5, 1.5}) nearest = std::min(nearest, to_segment(side * 3.5, end, side * 4.5, end));
  }
  return nearest;
}

/// What a robot's camera .6 m above the floor sees of the lines, from six places: brightness 90 on the carpet, 170 on
/// lines of .1 m, edges as soft as a pixel, noise of sigma 5. [k] is another place and other noise.
std::vector<Frame> synthetic_frames(int width, int height) {
  std::vector<Frame> frames;
  for (int k = 0; k < 6; ++k) {
    FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv422p, width, height, ColorRange::limited);
    std::mt19937 random(static_cast<unsigned>(k));
    std::normal_distribution<double> noise(0, 5);
    const double focal = .8 * width, pitch = .35, camera_x = -3.3 + .9 * k, camera_y = -1.6 + .5 * k,
                 theta = .25 * k - .5;
    const auto floor_distance = [&](double c, double r) {
      const double right = (c - width / 2.) / focal, down = (r - height / 2.) / focal;
      const double sink = std::sin(pitch) + down * std::cos(pitch);
      if (sink <= 1e-3) return 1e3;
      const double scale = .6 / sink, forward = scale * (std::cos(pitch) - down * std::sin(pitch)),
                   left = -scale * right;
      return distance_to_lines(camera_x + forward * std::cos(theta) - left * std::sin(theta),
                               camera_y + forward * std::sin(theta) + left * std::cos(theta));
    };
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c) {
        constexpr int kFine = 3;  // samples a pixel, each way
        int inside = 0;
        for (int i = 0; i < kFine; ++i)
          for (int j = 0; j < kFine; ++j) inside += floor_distance(c + (i - 1.) / kFine, r + (j - 1.) / kFine) <= .05;
        const double brightness = 90 + 80. * inside / (kFine * kFine) + noise(random);
        buffer.planes[0][r * buffer.strides[0] + c] = static_cast<std::uint8_t>(std::lround(brightness));
      }
    frames.push_back(buffer.frame);
  }
  return frames;
}

std::string size_of(const Frame& frame) {
  return std::to_string(frame.view.width()) + "x" + std::to_string(frame.view.height());
}

FieldLines synthetic(int width, int height) {
  FieldLines made;
  made.frames = synthetic_frames(width, height);
  for (const Frame& frame : made.frames) {
    const std::uint8_t* const first = frame.view.row(0).y;
    made.lines.push_back(
        region_where({first, width, height, frame.view.row(1).y - first}, [](int y) { return y > 130; }));
  }
  made.name = size_of(made.frames[0]) + " synthetic";
  return made;
}

FieldLines recorded(const std::string& name, const std::string& samples) {
  test::Recording recording = test::load_recording(name, samples);
  const Classifier classifier(recording.setup.colors);
  FieldLines made;
  made.frames = std::move(recording.frames);
  for (const Frame& frame : made.frames) made.lines.push_back(segment(frame.view, classifier).of(ColorClass::white));
  made.name = size_of(made.frames[0]) + " recorded (" + name + ")";
  return made;
}

}  // namespace

const FieldLines& field_lines(int index) {
  static std::map<int, FieldLines> made;
  if (!made.contains(index)) {
    if (index == 0) made[index] = synthetic(640, 480);
    if (index == 1) made[index] = synthetic(1920, 1080);
    if (index == 2) made[index] = recorded("d06_vga", "train_vga/samples.yaml");
    if (index == 3) made[index] = recorded("d01_approach", "train_div/samples.yaml");
  }
  return made.at(index);
}

}  // namespace tassilo::bench
