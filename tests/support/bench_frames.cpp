#include "support/bench_frames.h"

#include <time.h>

#include <array>
#include <map>
#include <random>

#include "support/recording.h"
#include "tassilo/base/contract.h"
#include "tassilo/base/median.h"

namespace tassilo::test {
namespace {

struct Kind {
  const char *recording, *samples;
  int width, height;
  double sigma_y, sigma_uv;
  bool ragged = false;
};
constexpr Kind kKinds[kBenchFrames] = {
    {"d01_approach", "train_div/samples.yaml", 384, 172, 0, 0},
    {"d06_vga", "train_vga/samples.yaml", 640, 480, 0, 0},
    {"d06_vga", "train_vga/samples.yaml", 640, 480, 5, 3},
    {"d06_vga", "train_vga/samples.yaml", 640, 480, 10, 6},
    {"d06_vga", "train_vga/samples.yaml", 1280, 960, 5, 3},
    {"d06_vga", "train_vga/samples.yaml", 1920, 1080, 5, 3},
    {"d06_vga", "train_vga/samples.yaml", 640, 480, 5, 3, true},
};

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

/// Time this thread has worked, as the benchmarks count: others may want the core, too.
double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

BenchFrames load(const Kind& kind) {
  Recording recording = load_recording(kind.recording, kind.samples);
  std::mt19937 random(1);
  const AddedNoise noise{kind.sigma_y, kind.sigma_uv};
  if (kind.sigma_y > 0) recording.setup.colors = trained_colors(kind.samples, noise);
  if (kind.ragged) recording.setup.colors = with_ragged_rims(recording.setup.colors, random);
  const bool noisy = kind.sigma_y > 0;
  BenchFrames frames{std::to_string(kind.width) + "x" + std::to_string(kind.height) +
                         (noisy ? " noise " + std::to_string(static_cast<int>(kind.sigma_y)) + "/" +
                                      std::to_string(static_cast<int>(kind.sigma_uv))
                                : "") +
                         (kind.ragged ? " ragged" : ""),
                     {},
                     Classifier(recording.setup.colors)};
  for (std::size_t i = 0; i < 8; ++i)
    frames.frames.push_back(
        resized(recording.frames[i % recording.frames.size()], kind.width, kind.height, noise, random));
  return frames;
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

double BenchFrames::reference_seconds() const {
  static std::map<std::string, double> known;
  if (const auto it = known.find(name); it != known.end()) return it->second;
  std::vector<double> seconds;
  std::size_t count = 0;
  for (int i = 0; i < 400; ++i) {
    const double start = thread_seconds();
    scalar_reference(next(count));
    seconds.push_back(thread_seconds() - start);
  }
  return known[name] = median(std::move(seconds));
}

void BenchFrames::report(benchmark::State& state) const {
  state.SetLabel(name);
  state.SetItemsProcessed(state.iterations() * width() * height());
  state.counters["x_reference"] = benchmark::Counter(
      reference_seconds(), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

const BenchFrames& bench_frames(int index) {
  static std::map<int, BenchFrames> loaded;
  if (!loaded.contains(index)) loaded.emplace(index, load(kKinds[index]));
  return loaded.at(index);
}

}  // namespace tassilo::test
