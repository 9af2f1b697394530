#include "support/bench_frames.h"

#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <random>

#include "support/measure.h"
#include "support/recording.h"

namespace tassilo::test {
namespace {

struct Kind {
  int width, height;
  AddedNoise noise;
  const char* recording = nullptr;  ///< Null: the painted scene.
  const char* samples = nullptr;
  bool ragged = false;
};
constexpr Kind kKinds[kBenchFrames] = {
    {384, 172, {}, "d01_approach", "train_div/samples.yaml"},
    {640, 480, {}, "d06_vga", "train_vga/samples.yaml"},
    {384, 172, {5, 3}},
    {640, 480, {5, 3}},
    {1280, 960, {5, 3}},
    {1920, 1080, {5, 3}},
    {640, 480, {10, 6}},
    {640, 480, {5, 3}, nullptr, nullptr, true},
    {640, 480, {5, 3}, "d06_vga", "train_vga/samples.yaml"},
};

/// A color in the middle of its class.
struct Paint {
  ColorClass color;
  std::uint8_t y, u, v;
};
constexpr Paint kNeutral{ColorClass::no_color, 110, 128, 128};
constexpr Paint kPaints[] = {
    {ColorClass::black, 40, 128, 128}, {ColorClass::white, 200, 128, 128}, {ColorClass::green, 90, 96, 94},
    {ColorClass::blue, 70, 190, 112},  {ColorClass::cyan, 140, 168, 70},   {ColorClass::magenta, 110, 176, 190},
    {ColorClass::red, 100, 92, 210},   {ColorClass::yellow, 170, 52, 150},
};
const Paint& paint_of(ColorClass color) { return kPaints[class_index(color)]; }

/// Every class holds four standard deviations of the stronger noise.
ColorTable painted_table() {
  ColorTable table;
  for (const Paint& paint : kPaints) {
    for (int v = 0; v < 256; ++v)
      for (int u = 0; u < 256; ++u)
        if (std::hypot(u - paint.u, v - paint.v) <= 24) table.cell(u, v) |= class_bit(paint.color);
    table.brightness[static_cast<std::size_t>(class_index(paint.color))] = {paint.y - 40, paint.y + 40};
  }
  table.brightness[static_cast<std::size_t>(class_index(ColorClass::black))] = {0, 80};
  return table;
}

/// A field as a robot sees it, in shares of the image: hall, wall, goals, carpet, lines, robots, a ball. `shift` moves
/// what stands on it.
Paint painted(double x, double y, double shift) {
  const auto within = [&](double x0, double y0, double x1, double y1) {
    return x >= x0 + shift && x < x1 + shift && y >= y0 && y < y1;
  };
  if (std::hypot(x - .45 - shift, (y - .62) * .7) < .03) return paint_of(ColorClass::red);
  for (const double robot : {.12, .62, .8}) {
    if (within(robot + .02, .24, robot + .06, .3)) return paint_of(robot < .7 ? ColorClass::cyan : ColorClass::magenta);
    if (within(robot, .3, robot + .1, .58)) return paint_of(ColorClass::black);
  }
  if (within(.3, .16, .55, .34)) return paint_of(ColorClass::yellow);
  if (within(-.1, .18, .06, .35)) return paint_of(ColorClass::blue);
  if (y < .2) return within(.7, .05, .76, .2) ? paint_of(ColorClass::red) : kNeutral;
  if (y < .36) return paint_of(ColorClass::white);
  if (std::abs(y - .45 - .1 * x) < .008 || std::abs(x - .5 - .6 * (y - .5)) < .01) return paint_of(ColorClass::white);
  return paint_of(ColorClass::green);
}

Frame painted_frame(int width, int height, double shift) {
  FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv422p, width, height, ColorRange::limited);
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      const Paint paint = painted((c + .5) / width, (r + .5) / height, shift);
      buffer.planes[0][r * buffer.strides[0] + c] = paint.y;
      buffer.planes[1][r * buffer.strides[1] + c / 2] = paint.u;
      buffer.planes[2][r * buffer.strides[2] + c / 2] = paint.v;
    }
  return buffer.frame;
}

/// Every stretch of a class begins and ends some cells off, another number in each row: as tables painted by hand.
ColorTable with_ragged_rims(const ColorTable& smooth, std::mt19937& random) {
  ColorTable table = smooth;
  for (int v = 0; v < 256; ++v)
    for (int u = 2; u < 254; ++u)
      if (smooth.cell(u, v) != smooth.cell(u - 1, v)) {
        const int shift = static_cast<int>(random() % 5) - 2;
        for (int k = u; k < u + shift; ++k) table.cell(k, v) = smooth.cell(u - 1, v);
        for (int k = u + shift; k < u; ++k) table.cell(k, v) = smooth.cell(u, v);
      }
  return table;
}

BenchFrames load(const Kind& kind) {
  std::mt19937 random(1);
  std::vector<Frame> frames;
  ColorTable colors;
  std::string name = std::to_string(kind.width) + "x" + std::to_string(kind.height);
  if (kind.recording != nullptr) {
    const Recording recording = load_recording(kind.recording, kind.samples);
    colors = kind.noise.y > 0 ? trained_colors(kind.samples, kind.noise) : recording.setup.colors;
    frames.assign(recording.frames.begin(), recording.frames.begin() + 8);
    name += " recorded";
  } else {
    colors = painted_table();
    for (int i = 0; i < 8; ++i) frames.push_back(painted_frame(kind.width, kind.height, .01 * i));
  }
  if (kind.noise.y > 0) {
    for (Frame& frame : frames) frame = resized(frame, kind.width, kind.height, kind.noise, random);
    name += " noise " + std::to_string(std::lround(kind.noise.y)) + "/" + std::to_string(std::lround(kind.noise.uv));
  }
  if (kind.ragged) {
    colors = with_ragged_rims(colors, random);
    name += " ragged";
  }
  return {name, std::move(frames), Classifier(colors)};
}

}  // namespace

void BenchFrames::scalar_reference(const Frame& frame) const {
  const ColorTable& table = classifier.table();
  static thread_local std::vector<ClassBits> out;
  std::array<ClassBits, 256> bright{};
  for (int y = 0; y < 256; ++y)
    for (const ColorClass color : kColorClasses)
      if (table.brightness[static_cast<std::size_t>(class_index(color))].contains(y))
        bright[static_cast<std::size_t>(y)] |= class_bit(color);
  const FrameView& view = frame.view;
  out.resize(static_cast<std::size_t>(view.width()) * static_cast<std::size_t>(view.height()));
  for (int r = 0; r < view.height(); ++r) {
    const YuvRow row = view.row(r);
    ClassBits* to = out.data() + static_cast<std::ptrdiff_t>(r) * view.width();
    for (int c = 0; c + 1 < view.width(); c += 2) {
      const ClassBits chroma = table.chroma[static_cast<std::size_t>(row.v[c / 2] * 256 + row.u[c / 2])];
      to[c] = chroma & bright[row.y[c]];
      to[c + 1] = chroma & bright[row.y[c + 1]];
    }
  }
  benchmark::DoNotOptimize(out.data());
  benchmark::ClobberMemory();
}

void BenchFrames::copy(const Frame& frame) const {
  static thread_local std::vector<std::uint8_t> to;
  const FrameView& view = frame.view;
  to.resize(static_cast<std::size_t>(2 * view.width() * view.height()));
  std::uint8_t* next = to.data();
  for (int r = 0; r < view.height(); ++r) {
    const YuvRow row = view.row(r);
    const auto width = static_cast<std::size_t>(view.width());
    std::memcpy(next, row.y, width);
    std::memcpy(next + width, row.u, width / 2);
    std::memcpy(next + width + width / 2, row.v, width / 2);
    next += 2 * width;
  }
  benchmark::DoNotOptimize(to.data());
  benchmark::ClobberMemory();
}

double BenchFrames::reference_seconds() const {
  static std::map<std::string, double> known;
  if (const auto it = known.find(name); it != known.end()) return it->second;
  PassTimer timer(frames.size());
  for (int pass = 0; pass < 50; ++pass)
    for (std::size_t k = 0; k < frames.size(); ++k) {
      scalar_reference(frames[timer.next()]);
      timer.called();
    }
  return known[name] = timer.seconds();
}

void BenchFrames::report(benchmark::State& state) const {
  state.SetLabel(name);
  state.SetItemsProcessed(state.iterations() * width() * height());
  state.counters["x_reference"] = state.counters["us"] / (1e6 * reference_seconds());
}

const BenchFrames& bench_frames(int index) {
  static std::map<int, BenchFrames> loaded;
  if (!loaded.contains(index)) loaded.emplace(index, load(kKinds[index]));
  return loaded.at(index);
}

}  // namespace tassilo::test
