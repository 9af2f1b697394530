// How much memory does segmentation take, from its first frame to the steady state, and how much a region and a label
// image? Counted, not computed: every operator new and delete of the process, by the bytes that malloc really sets
// aside. Each size is measured in a process of its own, as what is freed is kept for the next frame.

#if defined(__GNUC__) && !defined(__clang__)
// Where g++ 12 inlines one of our operators and not the other, it takes `free` for the wrong end of `new`.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif

#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <new>
#include <utility>
#include <vector>

#include "bench.h"
#include "support/bench_frames.h"
#include "tassilo/base/contract.h"
#include "tassilo/color/segment.h"

namespace {

std::int64_t allocations = 0, held_bytes = 0, peak_bytes = 0;

void* counted(std::size_t bytes, std::size_t alignment) {
  const std::size_t rounded = (std::max<std::size_t>(bytes, 1) + alignment - 1) / alignment * alignment;
  void* const block = std::aligned_alloc(alignment, rounded);
  if (block == nullptr) throw std::bad_alloc();
  ++allocations;
  held_bytes += static_cast<std::int64_t>(malloc_usable_size(block));
  peak_bytes = std::max(peak_bytes, held_bytes);
  return block;
}
void release(void* block) {
  if (block != nullptr) held_bytes -= static_cast<std::int64_t>(malloc_usable_size(block));
  std::free(block);
}

}  // namespace

void* operator new(std::size_t bytes) { return counted(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted(bytes, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  try {
    return operator new(bytes);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* block) noexcept { release(block); }
void operator delete(void* block, std::size_t) noexcept { release(block); }
void operator delete(void* block, std::align_val_t) noexcept { release(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { release(block); }

namespace tassilo::bench {
namespace {

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
  peak_bytes = held_bytes;
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
