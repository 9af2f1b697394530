#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

#include "support/measure.h"
#include "tassilo/color/segment.h"

// What all benchmarks share. A benchmark's names are task/contender/argument: bench/report reads them.

namespace tassilo::bench {

using test::measure;

/// Registers the benchmarks of the program; each has one, which main.cpp calls.
void register_benchmarks();

/// Registers task/contender for each of the arguments, most often indices of `test::bench_frames`.
void add(const std::string& name, const std::vector<int>& arguments, std::function<void(benchmark::State&)> run);

/// memcpy/argument and scalar_reference/argument: what every figure of the process can be held against.
void add_yardsticks(const std::vector<int>& frames);

/// The full chain: frame -> 8 classes, opened by 3 x 3, 8-connected components, area, centre and box of each.
Segmentation chain(const Frame& frame, const Classifier& classifier, Segmentation recycled);

/// The library calls a benchmark several times until it has run for long enough: `check` runs in the first call with
/// that name only.
void once(const std::string& name, const std::function<void()>& check);

}  // namespace tassilo::bench
