// How long does segmentation take, from a frame in memory to one region a class, for each kernel? Frames of the shipped
// recordings, whose tables are really trained, and painted frames with noise and at other sizes, cycled so that no
// branch predictor knows them by heart. Before any time counts every kernel's segmentation, opening and chain is
// compared with that of the plain kernel, and the opening of all classes at once with that of each region. The scalar
// reference and memcpy run in the same process: compare ratios (counter x_reference), not microseconds.

#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "bench.h"
#include "support/bench_frames.h"
#include "tassilo/base/contract.h"
#include "tassilo/base/kernel.h"
#include "tassilo/color/segment.h"
#include "tassilo/region/morphology.h"

namespace tassilo::bench {
namespace {

const test::BenchFrames& frames_of(const benchmark::State& state) {
  return test::bench_frames(static_cast<int>(state.range(0)));
}
std::string check_name(const benchmark::State& state, const std::string& task, Kernel kernel) {
  return task + std::string(to_string(kernel)) + std::to_string(state.range(0));
}

void segmenting(benchmark::State& state, Kernel kernel) {
  const test::BenchFrames& frames = frames_of(state);
  Segmentation fast;
  once(check_name(state, "segment", kernel), [&] {
    Segmentation plain;
    for (const Frame& frame : frames.frames) {
      use_kernel(Kernel::plain);
      plain = segment(frame.view, frames.classifier, std::move(plain));
      use_kernel(kernel);
      fast = segment(frame.view, frames.classifier, std::move(fast));
      expects(plain.labels == fast.labels && plain.regions == fast.regions, "a kernel equals the plain one");
    }
  });
  use_kernel(kernel);
  std::size_t runs = 0;
  for (const Frame& frame : frames.frames) {
    fast = segment(frame.view, frames.classifier, std::move(fast));
    for (const Region& region : fast.regions) runs += region.runs().size();
  }
  state.counters["runs"] = static_cast<double>(runs) / static_cast<double>(frames.frames.size());
  state.counters["pixels"] = frames.width() * frames.height();
  measure(state, frames.frames.size(), [&](std::size_t k) {
    fast = segment(frames.frames[k].view, frames.classifier, std::move(fast));
    benchmark::DoNotOptimize(fast.labels.data());
  });
  frames.report(state);
}

void opening_all(benchmark::State& state, Kernel kernel) {
  const test::BenchFrames& frames = frames_of(state);
  use_kernel(kernel);
  std::vector<Segmentation> segmented;
  for (const Frame& frame : frames.frames) segmented.push_back(segment(frame.view, frames.classifier));
  Segmentation opened;
  once(check_name(state, "opening3x3", kernel), [&] {
    for (const Segmentation& from : segmented) {
      opened = opening3x3(from, std::move(opened));
      for (const ColorClass color : kColorClasses)
        expects(opened.of(color) == opening(from.of(color), rectangle(3, 3)), "all at once is each region opened");
    }
  });
  measure(state, segmented.size(), [&](std::size_t k) {
    opened = opening3x3(segmented[k], std::move(opened));
    benchmark::DoNotOptimize(opened.labels.data());
  });
  frames.report(state);
}

void chains(benchmark::State& state, Kernel kernel) {
  const test::BenchFrames& frames = frames_of(state);
  use_kernel(kernel);
  Segmentation opened;
  once(check_name(state, "chain", kernel), [&] {
    for (const Frame& frame : frames.frames) {
      opened = segment_opened(frame.view, frames.classifier, std::move(opened));
      expects(opened.regions == opening3x3(segment(frame.view, frames.classifier)).regions,
              "segmentation opened at once is one opened afterwards");
    }
  });
  measure(state, frames.frames.size(),
          [&](std::size_t k) { opened = chain(frames.frames[k], frames.classifier, std::move(opened)); });
  frames.report(state);
}

}  // namespace

void register_benchmarks() {
  std::vector<int> all(test::kBenchFrames);
  std::iota(all.begin(), all.end(), 0);
  add_yardsticks(all);
  for (const Kernel kernel : supported_kernels()) {
    const std::string name(to_string(kernel));
    add("segment/" + name, all, [kernel](benchmark::State& state) { segmenting(state, kernel); });
    add("opening3x3/" + name, all, [kernel](benchmark::State& state) { opening_all(state, kernel); });
    add("chain/" + name, all, [kernel](benchmark::State& state) { chains(state, kernel); });
  }
}

}  // namespace tassilo::bench
