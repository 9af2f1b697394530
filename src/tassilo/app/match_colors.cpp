#include "tassilo/app/match_colors.h"

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "tassilo/color/quality.h"
#include "tassilo/color/train.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/raster.h"

namespace tassilo {
namespace {

/// Pixels that surely are of a class: those whose neighbors are, too, over the width of two chroma samples.
void take_samples(const Frame& frame, const SimView& view, int group, std::vector<ColorSample>& samples) {
  const ByteView labels{view.labels.data(), view.width, view.height, view.width};
  for (int label = 0; label <= kColorClassCount; ++label) {
    const Region region = region_where(labels, [&](int value) { return value == label; });
    std::vector<YuvPixel> pixels = pixels_of(frame.view, erosion(region, rectangle(5, 5)));
    if (!pixels.empty()) samples.push_back({static_cast<ColorClass>(label), group, std::move(pixels)});
  }
}

/// Share of the samples' pixels that a table of the other stills classifies right.
double quality_of(const std::vector<ColorSample>& samples, ColorRange range) {
  const ColorQuality quality = cross_validate(samples, range);
  std::int64_t right = 0, all = 0;
  for (std::size_t label = 0; label < quality.confusion.size(); ++label) {
    right += quality.confusion[label][label];
    for (const std::int64_t pixels : quality.confusion[label]) all += pixels;
  }
  return all > 0 ? static_cast<double>(right) / static_cast<double>(all) : 0;
}

}  // namespace

TrainedHall train_on_stills(Renderer& renderer, const FieldModel& field, std::uint64_t seed) {
  constexpr int stills = 16;
  std::mt19937_64 random(seed + 1);
  std::uniform_real_distribution<double> place(-0.4, 0.4), angle(-3.1, 3.1);
  std::vector<ColorSample> samples;
  for (int still = 0; still < stills; ++still) {
    SimState state;
    state.ball.radius = field.ball.radius.middle();
    SimRobot eye;
    eye.id = 1;
    eye.radius = field.robots.width.middle() / 2;
    eye.height = field.robots.height.middle();
    eye.at = {place(random) * field.length, place(random) * field.width};
    // Goals are what is rarest: every other still looks at one.
    const double goal_x = still % 4 < 2 ? field.length / 2 : -field.length / 2;
    eye.theta = still % 2 == 0 ? std::atan2(-eye.at.y, goal_x - eye.at.x) : angle(random);
    const FieldFromRobot before = pose_of(eye);
    state.ball.at = before * FloorPoint{0.7 + 0.08 * still, still % 3 - 1.};
    SimRobot cyan = eye, magenta = eye;
    cyan.id = 2;
    cyan.at = before * FloorPoint{1.2, 0.5};
    magenta.id = 3;
    magenta.team = Team::magenta;
    magenta.at = before * FloorPoint{1.3, -0.6};
    state.robots = {eye, cyan, magenta};
    const Frame frame = renderer.render(state, eye.id);
    take_samples(frame, renderer.look(state, eye.id), still, samples);
  }
  const ColorRange range = renderer.options().range;
  return {train_colors(samples, range), quality_of(samples, range)};
}

}  // namespace tassilo
