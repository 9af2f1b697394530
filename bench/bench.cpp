#include "bench.h"

#include <set>
#include <utility>

#include "support/bench_frames.h"
#include "tassilo/region/components.h"

namespace tassilo::bench {

void add(const std::string& name, const std::vector<int>& arguments, std::function<void(benchmark::State&)> run) {
  benchmark::internal::Benchmark* const added = benchmark::RegisterBenchmark(name.c_str(), std::move(run));
  for (const int argument : arguments) added->Arg(argument);
  added->Unit(benchmark::kMicrosecond);
}

void add_yardsticks(const std::vector<int>& frames) {
  const auto yardstick = [&](const std::string& name, void (test::BenchFrames::*run)(const Frame&) const) {
    add(name, frames, [run](benchmark::State& state) {
      const test::BenchFrames& inputs = test::bench_frames(static_cast<int>(state.range(0)));
      measure(state, inputs.frames.size(), [&](std::size_t k) { (inputs.*run)(inputs.frames[k]); });
      inputs.report(state);
    });
  };
  yardstick("memcpy", &test::BenchFrames::copy);
  yardstick("scalar_reference", &test::BenchFrames::scalar_reference);
}

Segmentation chain(const Frame& frame, const Classifier& classifier, Segmentation recycled) {
  recycled = segment_opened(frame.view, classifier, std::move(recycled));
  for (const ColorClass color : kColorClasses) benchmark::DoNotOptimize(component_features(recycled.of(color)).data());
  return recycled;
}

void once(const std::string& name, const std::function<void()>& check) {
  static std::set<std::string> checked;
  if (!checked.insert(name).second) return;
  check();
}

}  // namespace tassilo::bench
