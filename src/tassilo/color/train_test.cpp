#include "tassilo/color/train.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "tassilo/base/error.h"
#include "tassilo/color/internal/uv_plane.h"
#include "tassilo/color/quality.h"

namespace tassilo {
namespace {

struct Paint {
  ColorClass color;
  double y, u, v;  ///< In full light.
};
constexpr Paint kPaints[] = {{ColorClass::green, 110, 115, 105}, {ColorClass::red, 120, 95, 185},
                             {ColorClass::yellow, 175, 75, 153}, {ColorClass::blue, 80, 168, 110},
                             {ColorClass::white, 200, 127, 128}, {ColorClass::black, 45, 128, 128}};

YuvPixel shaded(const Paint& paint, double light, std::mt19937& random) {
  std::normal_distribution<double> noise(0, 1);
  const auto byte = [](double value) { return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L)); };
  return {byte(16 + (paint.y - 16) * light + 3 * noise(random)), byte(128 + (paint.u - 128) * light + noise(random)),
          byte(128 + (paint.v - 128) * light + noise(random))};
}

std::vector<YuvPixel> pixels(const Paint& paint, double darkest, int count, std::mt19937& random) {
  std::uniform_real_distribution<double> light(darkest, 1);
  std::vector<YuvPixel> all;
  for (int i = 0; i < count; ++i) all.push_back(shaded(paint, light(random), random));
  return all;
}

std::vector<ColorSample> samples_of_all(double darkest, std::mt19937& random) {
  std::vector<ColorSample> samples;
  for (int group = 0; group < 3; ++group)
    for (const Paint& paint : kPaints) samples.push_back({paint.color, group, pixels(paint, darkest, 1500, random)});
  return samples;
}

double recall(const ColorTable& table, const Paint& paint, double darkest, std::mt19937& random) {
  const Classifier classify(table);
  int right = 0;
  const auto all = pixels(paint, darkest, 4000, random);
  for (const YuvPixel& p : all) right += classify(p.y, p.u, p.v) == paint.color;
  return static_cast<double>(right) / static_cast<double>(all.size());
}

TEST(TrainColors, NamesUnseenPixelsOfTheSamePaints) {
  std::mt19937 random(1);
  const ColorTable table = train_colors(samples_of_all(0.8, random), ColorRange::limited);
  for (const Paint& paint : kPaints) EXPECT_GT(recall(table, paint, 0.8, random), 0.99) << to_string(paint.color);
}

// A colored surface in shade moves towards gray and black in proportion; the samples showed full light only.
TEST(TrainColors, NamesDarkerShadesThanItsSamples) {
  std::mt19937 random(2);
  const ColorTable table = train_colors(samples_of_all(0.95, random), ColorRange::limited);
  for (const Paint& paint : kPaints)
    if (paint.color != ColorClass::white) {
      EXPECT_GT(recall(table, paint, 0.6, random), 0.95) << to_string(paint.color);
    }
}

TEST(TrainColors, AFewWrongPixelsInAPolygonChangeLittle) {
  std::mt19937 random(3);
  auto samples = samples_of_all(0.8, random);
  for (ColorSample& sample : samples)
    if (sample.color == ColorClass::red) {
      const auto slip = pixels(kPaints[0], 0.8, 45, random);  // 3 % of the red samples are carpet
      sample.pixels.insert(sample.pixels.end(), slip.begin(), slip.end());
    }
  const ColorTable table = train_colors(samples, ColorRange::limited);
  for (const Paint& paint : kPaints) EXPECT_GT(recall(table, paint, 0.8, random), 0.99) << to_string(paint.color);
}

TEST(TrainColors, ClassesWithoutSamplesStayEmpty) {
  std::mt19937 random(4);
  const ColorTable table = train_colors({{ColorClass::red, 0, pixels(kPaints[1], 0.8, 500, random)}}, ColorRange::full);
  EXPECT_EQ(table.range, ColorRange::full);
  for (const ClassBits bits : table.chroma) EXPECT_EQ(bits & ~class_bit(ColorClass::red), 0);
  const ColorTable nothing = train_colors({}, ColorRange::full);
  for (const ClassBits bits : nothing.chroma) EXPECT_EQ(bits, 0);
}

TEST(TrainColors, GrayThatIsNoClassBoundsBlackAndWhite) {
  std::mt19937 random(5);
  auto samples = samples_of_all(0.9, random);
  const Paint hall{ColorClass::no_color, 150, 128, 128};
  samples.push_back({ColorClass::no_color, 0, pixels(hall, 0.9, 2000, random)});
  const ColorTable table = train_colors(samples, ColorRange::limited);
  EXPECT_LT(recall(table, {ColorClass::white, 150, 128, 128}, 0.95, random), 0.02);
  EXPECT_GT(recall(table, {ColorClass::white, 200, 127, 128}, 0.95, random), 0.98);
}

// An image without chroma: whatever class it is said to be, nothing far from neutral joins it.
TEST(TrainColors, ANeutralColorHasNoShadesElsewhere) {
  for (const ColorClass color : {ColorClass::green, ColorClass::black}) {
    const std::vector<YuvPixel> neutral(200, YuvPixel{100, 128, 128});
    const ColorTable table = train_colors({{color, 0, neutral}}, ColorRange::full);
    EXPECT_EQ(classify(table, 100, 128, 128), color);
    for (int v = 0; v < 256; ++v)
      for (int u = 0; u < 256; ++u)
        if (std::hypot(u - 128, v - 128) > 10) {
          ASSERT_EQ(table.cell(u, v), 0) << u << ", " << v;
        }
  }
}

TEST(TrainingOptions, RefusesWhatIsOutOfRange) {
  TrainingOptions options;
  options.darkest_shade = 0;
  EXPECT_THROW(train_colors({}, ColorRange::full, options), Error);
}

TEST(CrossValidate, CountsEverySampleOnceAndFindsTheWeakClass) {
  std::mt19937 random(6);
  auto samples = samples_of_all(0.8, random);
  // A paint whose every image shows another color cannot be learned from the others.
  const Paint odd[] = {
      {ColorClass::cyan, 110, 170, 60}, {ColorClass::cyan, 110, 190, 150}, {ColorClass::cyan, 110, 60, 60}};
  for (int group = 0; group < 3; ++group)
    samples.push_back({ColorClass::cyan, group, pixels(odd[group], 0.9, 1000, random)});
  const ColorQuality quality = cross_validate(samples, ColorRange::limited);
  EXPECT_EQ(quality.pixels(ColorClass::green), 4500);
  EXPECT_EQ(quality.pixels(ColorClass::cyan), 3000);
  EXPECT_GT(quality.recall(ColorClass::green).value(), 0.99);
  EXPECT_LT(quality.recall(ColorClass::cyan).value(), 0.1);
  EXPECT_EQ(quality.recall(ColorClass::magenta), std::nullopt);
}

// Held out, the only sample of a class leaves none to learn the class from: that says nothing about it.
TEST(CrossValidate, DoesNotCountAClassThatTheOthersLack) {
  std::mt19937 random(6);
  auto samples = samples_of_all(0.8, random);
  samples.push_back({ColorClass::cyan, 0, pixels({ColorClass::cyan, 110, 170, 60}, 0.9, 1000, random)});
  const ColorQuality quality = cross_validate(samples, ColorRange::limited);
  EXPECT_EQ(quality.pixels(ColorClass::green), 4500);
  EXPECT_EQ(quality.recall(ColorClass::cyan), std::nullopt);
}

TEST(DistanceTo, EqualsBruteForce) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> at(0, 255);
  for (const int count : {0, 1, 2, 40}) {
    RunVector runs;
    for (int i = 0; i < count; ++i) {
      const int u = at(random);
      runs.push_back(
          {static_cast<std::int16_t>(at(random)), static_cast<std::int16_t>(u), static_cast<std::int16_t>(u + 1)});
    }
    const Region cells = Region::from_runs(runs);
    const UvPlane<double> distance = distance_to(cells);
    for (int trial = 0; trial < 2000; ++trial) {
      const int u = at(random), v = at(random);
      double nearest = std::numeric_limits<double>::infinity();
      for (const PixelRun& run : cells.runs())
        for (int x = run.begin; x < run.end; ++x) nearest = std::min(nearest, std::hypot(x - u, run.row - v));
      if (cells.empty()) {
        EXPECT_EQ(distance(u, v), nearest);
      } else {
        EXPECT_NEAR(distance(u, v), nearest, 1e-9);
      }
    }
  }
}

TEST(TrainColors, BrightnessSetByHandIsTaken) {
  std::mt19937 random(9);
  const auto samples = samples_of_all(0.8, random);
  TrainingOptions options;
  options.brightness[static_cast<std::size_t>(class_index(ColorClass::green))] = {40, 80};
  ColorTable expected = train_colors(samples, ColorRange::limited);
  expected.brightness[static_cast<std::size_t>(class_index(ColorClass::green))] = {40, 80};
  EXPECT_EQ(train_colors(samples, ColorRange::limited, options), expected);
}

TEST(TrainingOptions, NumbersKnowTheirRange) {
  for (const TrainingNumber& number : training_numbers()) {
    TrainingOptions options;
    EXPECT_NO_THROW(number.set(options, number.low));
    EXPECT_EQ(number.of(options), number.low) << number.key;
    EXPECT_THROW(number.set(options, number.high + 0.01), Error) << number.key;
    EXPECT_THROW(number.set(options, std::nan("")), Error) << number.key;
    EXPECT_EQ(number.of(options), number.low) << number.key;
    if (number.whole == nullptr) continue;
    EXPECT_THROW(number.set(options, number.low + 0.5), Error) << number.key;
  }
  TrainingOptions options;
  options.brightness[0] = {9, 8};
  EXPECT_THROW(options.check(), Error);
}

// Fast and plain are the same, whatever is drawn, removed or turned in whatever order.
TEST(IncrementalTraining, EqualsTrainingAnew) {
  std::mt19937 random(12);
  IncrementalTraining train;
  std::vector<std::shared_ptr<const ColorSample>> samples;
  TrainingOptions options;
  const auto number = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  for (int step = 0; step < 40; ++step) {
    switch (number(6)) {
      case 0:
        if (!samples.empty()) samples.erase(samples.begin() + number(static_cast<int>(samples.size())));
        break;
      case 1:
        options.closing_px = 1 + 2 * number(4);
        break;
      case 2:
        options.noise_margin = number(8);
        options.brightness[static_cast<std::size_t>(number(8))] = {number(100), 100 + number(100)};
        break;
      default:
        const Paint& paint = kPaints[number(6)];
        samples.push_back(std::make_shared<ColorSample>(ColorSample{paint.color, 0, pixels(paint, 0.7, 400, random)}));
        if (number(5) == 0)
          samples.back() = std::make_shared<ColorSample>(ColorSample{ColorClass::no_color, 0, samples.back()->pixels});
    }
    std::vector<ColorSample> copies;
    for (const auto& sample : samples) copies.push_back(*sample);
    ASSERT_EQ(train(samples, ColorRange::limited, options), train_colors(copies, ColorRange::limited, options)) << step;
  }
}

}  // namespace
}  // namespace tassilo
