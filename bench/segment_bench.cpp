// How long does segmentation take, from a frame in memory to one region a class, for each kernel? Frames of the shipped
// recordings, whose tables are really trained, and those frames with noise and at other sizes, cycled so that no branch
// predictor knows them by heart. Every kernel's segmentation is compared with the plain one's before any time counts;
// that openings and components are right is left to the tests. The scalar reference, and memcpy, run in the same
// process: compare ratios (counter x_reference), not milliseconds.

#include <benchmark/benchmark.h>

#include <cstring>

#include "support/bench_frames.h"
#include "tassilo/base/contract.h"
#include "tassilo/base/kernel.h"
#include "tassilo/color/segment.h"
#include "tassilo/region/components.h"
#include "tassilo/region/features.h"

namespace tassilo {
namespace {

using test::bench_frames;
using test::BenchFrames;

void BM_Memcpy(benchmark::State& state) {
  const BenchFrames& frames = bench_frames(static_cast<int>(state.range(0)));
  std::vector<std::uint8_t> to(static_cast<std::size_t>(frames.width() * frames.height() * 2));
  std::size_t next = 0;
  for (auto _ : state) {
    const FrameView& view = frames.next(next).view;
    const auto pixels = static_cast<std::size_t>(view.width() * view.height());
    std::memcpy(to.data(), view.row(0).y, pixels);
    std::memcpy(to.data() + pixels, view.row(0).u, pixels / 2);
    std::memcpy(to.data() + pixels + pixels / 2, view.row(0).v, pixels / 2);
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
  frames.report(state);
}

void BM_ScalarReference(benchmark::State& state) {
  const BenchFrames& frames = bench_frames(static_cast<int>(state.range(0)));
  std::size_t next = 0;
  for (auto _ : state) frames.scalar_reference(frames.next(next));
  frames.report(state);
}

void BM_Segment(benchmark::State& state, Kernel kernel) {
  const BenchFrames& frames = bench_frames(static_cast<int>(state.range(0)));
  Segmentation plain, fast;
  for (const Frame& frame : frames.frames) {
    use_kernel(Kernel::plain);
    plain = segment(frame.view, frames.classifier, std::move(plain));
    use_kernel(kernel);
    fast = segment(frame.view, frames.classifier, std::move(fast));
    expects(plain.labels == fast.labels && plain.regions == fast.regions, "a kernel equals the plain one");
  }
  std::size_t runs = 0;
  for (const Frame& frame : frames.frames) {
    fast = segment(frame.view, frames.classifier, std::move(fast));
    for (const Region& region : fast.regions) runs += region.runs().size();
  }
  const double runs_a_frame = static_cast<double>(runs) / static_cast<double>(frames.frames.size());
  state.counters["runs"] = runs_a_frame;
  state.counters["pixels"] = frames.width() * frames.height();
  state.counters["region_bytes"] = runs_a_frame * sizeof(PixelRun);
  std::size_t next = 0;
  for (auto _ : state) {
    fast = segment(frames.next(next).view, frames.classifier, std::move(fast));
    benchmark::DoNotOptimize(fast.labels.data());
  }
  frames.report(state);
}

void BM_Opening3x3(benchmark::State& state, Kernel kernel) {
  const BenchFrames& frames = bench_frames(static_cast<int>(state.range(0)));
  use_kernel(kernel);
  std::vector<Segmentation> segmented;
  for (const Frame& frame : frames.frames) segmented.push_back(segment(frame.view, frames.classifier));
  Segmentation opened;
  std::size_t next = 0;
  for (auto _ : state) {
    opened = opening3x3(segmented[next++ % segmented.size()], std::move(opened));
    benchmark::DoNotOptimize(opened.labels.data());
  }
  frames.report(state);
}

/// Frame -> 8 classes, opened by 3 x 3, 8-connected components, area, centre and box of each.
void BM_Chain(benchmark::State& state, Kernel kernel) {
  const BenchFrames& frames = bench_frames(static_cast<int>(state.range(0)));
  use_kernel(kernel);
  Segmentation opened;
  std::size_t next = 0, parts = 0;
  for (auto _ : state) {
    opened = segment_opened(frames.next(next).view, frames.classifier, std::move(opened));
    for (const ColorClass color : kColorClasses) {
      const auto blobs = component_features(opened.of(color));
      parts += blobs.size();
      benchmark::DoNotOptimize(blobs.data());
    }
  }
  state.counters["components"] = static_cast<double>(parts) / static_cast<double>(state.iterations());
  frames.report(state);
}

void register_all() {
  const auto over_frames = [](benchmark::internal::Benchmark* bench) {
    for (int k = 0; k < test::kBenchFrames; ++k) bench->Arg(k);
    bench->Unit(benchmark::kMicrosecond)->ReportAggregatesOnly(false);
  };
  over_frames(benchmark::RegisterBenchmark("memcpy", BM_Memcpy));
  over_frames(benchmark::RegisterBenchmark("scalar_reference", BM_ScalarReference));
  for (const Kernel kernel : supported_kernels()) {
    const std::string name(to_string(kernel));
    over_frames(benchmark::RegisterBenchmark(("segment/" + name).c_str(), BM_Segment, kernel));
    over_frames(benchmark::RegisterBenchmark(("opening3x3/" + name).c_str(), BM_Opening3x3, kernel));
    over_frames(benchmark::RegisterBenchmark(("chain/" + name).c_str(), BM_Chain, kernel));
  }
}

}  // namespace
}  // namespace tassilo

int main(int argc, char** argv) {
  tassilo::register_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
