// How much memory does segmentation take, from its first frame to the steady state, and how much a region and a label
// image? Counted, not computed: every operator new and delete of the process, by the bytes that malloc really sets
// aside. Each size is measured in a process of its own, as what is freed is kept for the next frame.

#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "bench.h"
#include "support/bench_frames.h"
#include "support/counted_new.h"
#include "tassilo/base/contract.h"
#include "tassilo/color/segment.h"

namespace tassilo::bench {
namespace {

using test::allocations;
using test::held_bytes;
using test::peak_bytes;

struct Memory {
  double runs = 0;               ///< Of all classes of a frame.
  double region_bytes = 0;       ///< Of all regions of a frame.
  double label_bytes = 0;        ///< Of its label image.
  double held = 0, peak = 0;     ///< More than before: once all frames have been seen, and at most until then. [bytes]
  double later_allocations = 0;  ///< Calls of operator new in two more passes over the frames.
};

/// By how much `make` grows the memory held, its result alive; the mean of many, as some memory was kept from before.
template <class Make>
double bytes_of(Make make) {
  constexpr std::size_t kCopies = 64;
  std::vector<decltype(make())> copies;
  copies.reserve(kCopies);
  const std::int64_t before = held_bytes;
  while (copies.size() < kCopies) copies.push_back(make());
  return static_cast<double>(held_bytes - before) / kCopies;
}

Memory measured_here(const test::BenchFrames& frames) {
  Memory memory;
  Segmentation segmentation;
  const auto pass = [&] {
    for (const Frame& frame : frames.frames)
      segmentation = segment(frame.view, frames.classifier, std::move(segmentation));
  };
  const std::int64_t before = held_bytes;
  peak_bytes = before;
  pass();
  pass();  // blocks may still move to where they are needed most
  memory.held = static_cast<double>(held_bytes - before);
  memory.peak = static_cast<double>(peak_bytes - before);
  const std::int64_t allocated = allocations;
  pass();
  pass();
  memory.later_allocations = static_cast<double>(allocations - allocated);
  for (const Region& region : segmentation.regions) memory.runs += static_cast<double>(region.runs().size());
  memory.region_bytes = bytes_of([&] { return segmentation.regions; });
  memory.label_bytes = bytes_of([&] { return segmentation.labels; });
  return memory;
}

/// In a process of its own, which has segmented nothing before.
Memory measured(const test::BenchFrames& frames) {
  int ends[2];
  expects(pipe(ends) == 0, "a pipe can be made");
  const pid_t child = fork();
  expects(child >= 0, "a process can be started");
  if (child == 0) {
    const Memory memory = measured_here(frames);
    _exit(write(ends[1], &memory, sizeof(memory)) == sizeof(memory) ? 0 : 1);
  }
  Memory memory;
  int status = 1;
  waitpid(child, &status, 0);
  expects(status == 0 && read(ends[0], &memory, sizeof(memory)) == sizeof(memory), "the process has told its memory");
  close(ends[0]);
  close(ends[1]);
  return memory;
}

void segmentation_memory(benchmark::State& state) {
  const test::BenchFrames& frames = test::bench_frames(static_cast<int>(state.range(0)));
  static std::map<int, Memory> known;
  const auto index = static_cast<int>(state.range(0));
  if (!known.contains(index)) known[index] = measured(frames);
  const Memory& memory = known[index];
  for (auto _ : state) benchmark::DoNotOptimize(memory);
  state.counters["runs"] = memory.runs;
  state.counters["region_bytes"] = memory.region_bytes;
  state.counters["label_bytes"] = memory.label_bytes;
  state.counters["frame_bytes"] = 2. * frames.width() * frames.height();
  state.counters["held_bytes"] = memory.held;
  state.counters["peak_bytes"] = memory.peak;
  state.counters["later_allocations"] = memory.later_allocations;
  state.SetLabel(frames.name);
}

}  // namespace

void register_benchmarks() { add("memory/segment", {0, 1, 2, 3, 4, 5, 8}, segmentation_memory); }

}  // namespace tassilo::bench
