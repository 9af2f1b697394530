// How long does a frame take from memory to scene, as a whole and by stage? On the shipped recordings, frames cycled.
// The scalar reference (one table lookup a pixel pair, one mask a pixel) runs in the same process: compare ratios.

#include <benchmark/benchmark.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "support/bench_frames.h"
#include "support/recording.h"
#include "tassilo/base/median.h"

namespace tassilo {
namespace {

using test::Recording;

const Recording& recording(int index) {
  static const std::array names{std::pair("d01_approach", "train_div/samples.yaml"),
                                std::pair("d06_vga", "train_vga/samples.yaml")};
  static std::map<int, Recording> loaded;
  const auto& [name, samples] = names[static_cast<std::size_t>(index)];
  if (!loaded.contains(index)) loaded.emplace(index, test::load_recording(name, samples));
  return loaded.at(index);
}

std::string size_label(const Frame& frame) {
  return std::to_string(frame.view.width()) + "x" + std::to_string(frame.view.height());
}

void BM_ScalarReference(benchmark::State& state) {
  const test::BenchFrames& frames = test::bench_frames(static_cast<int>(state.range(0)));
  std::size_t next = 0;
  for (auto _ : state) frames.scalar_reference(frames.next(next));
  frames.report(state);
}

void BM_FrameToScene(benchmark::State& state) {
  const Recording& r = recording(static_cast<int>(state.range(0)));
  const Vision vision(r.setup);
  VisionWorkspace workspace;
  std::map<std::string, std::vector<double>> stages;
  std::size_t next = 0;
  for (auto _ : state) {
    const Scene scene = vision(r.frames[next++ % r.frames.size()], workspace);
    for (const StageTime& time : scene.timing) stages[time.stage].push_back(time.ms);
  }
  for (auto& [stage, ms] : stages) state.counters[stage + "_ms"] = median(std::move(ms));
  state.SetLabel(size_label(r.frames[0]));
}

BENCHMARK(BM_ScalarReference)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_FrameToScene)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tassilo

BENCHMARK_MAIN();
