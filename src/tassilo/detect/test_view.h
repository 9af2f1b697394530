#pragma once

// A rendered world made ready for detectors, for tests.

#include <array>
#include <random>

#include "tassilo/camera/test_world.h"
#include "tassilo/color/train.h"
#include "tassilo/detect/view.h"

namespace tassilo::test {

/// A table that knows the paints of the test world.
inline ColorTable paint_table() {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 1.5);
  std::vector<ColorSample> samples;
  const std::pair<ColorClass, Paint> paints[] = {{ColorClass::green, kCarpet}, {ColorClass::red, kRed},
                                                 {ColorClass::white, kWhite},  {ColorClass::black, kBlack},
                                                 {ColorClass::cyan, kCyan},    {ColorClass::magenta, kMagenta},
                                                 {ColorClass::yellow, kYellow}};
  for (const auto& [color, paint] : paints) {
    ColorSample sample{color, 0, {}};
    for (int i = 0; i < 500; ++i) {
      const auto byte = [&](double value) { return static_cast<std::uint8_t>(std::lround(value + noise(random))); };
      sample.pixels.push_back({byte(paint.y), byte(paint.u), byte(paint.v)});
    }
    samples.push_back(std::move(sample));
  }
  return train_colors(samples, ColorRange::limited);
}

inline FieldModel test_field() {
  FieldModel field;
  field.name = "test";
  field.length = 10;
  field.width = 6;
  field.line_width = 0.05;
  field.walls = FieldModel::Walls{.color = "white", .height = 0.5, .x = {-5, 5}, .y = {-3, 3}};
  field.goals = {{GoalSide::minus_x, GoalColor::yellow, 1.5, 0.9, 0.5}};
  return field;
}

/// Owns what a View borrows.
struct Seen {
  Seen(const MountedCamera& camera, const World& world, bool calibrated = true)
      : frame(render(camera, world)),
        field(test_field()),
        optics(camera, {.x = 0, .y = 0, .z = 0, .roll = 0, .pitch = 0, .yaw = 0}) {
    static const Classifier classifier(paint_table());
    segmentation = segment(frame.view, classifier);
    const std::array colored{&segmentation.of(ColorClass::black), &segmentation.of(ColorClass::cyan),
                             &segmentation.of(ColorClass::magenta), &segmentation.of(ColorClass::red),
                             &segmentation.of(ColorClass::yellow)};
    surface = find_surface({.width = segmentation.width,
                            .height = segmentation.height,
                            .carpet = &segmentation.of(ColorClass::green),
                            .white = &segmentation.of(ColorClass::white),
                            .colored = colored},
                           calibrated ? &optics.ground : nullptr);
    is_calibrated = calibrated;
  }
  View view() const { return {frame.view, segmentation, surface, field, is_calibrated ? &optics : nullptr}; }

  Frame frame;
  FieldModel field;
  Optics optics;
  Segmentation segmentation;
  Surface surface;
  bool is_calibrated = true;
};

}  // namespace tassilo::test
