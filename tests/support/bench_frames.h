#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "tassilo/color/segment.h"
#include "tassilo/image/frame.h"

// For benchmarks only.

namespace tassilo::test {

/// Frames of a shipped recording in memory with their trained table, at one size and with one strength of added noise.
struct BenchFrames {
  std::string name;  ///< "640x480 noise 5/3".
  std::vector<Frame> frames;
  Classifier classifier;

  int width() const { return frames.front().view.width(); }
  int height() const { return frames.front().view.height(); }
  /// Another frame each time: no branch predictor may learn one by heart.
  const Frame& next(std::size_t& count) const { return frames[count++ % frames.size()]; }

  /// The denominator of all figures: one table lookup a pixel pair & one mask a pixel, a plain loop.
  void scalar_reference(const Frame& frame) const;
  /// Median time of the scalar reference on these frames, measured once in this process. [s]
  double reference_seconds() const;
  /// Label, pixels a second, and `x_reference`: time as a part of the scalar reference's.
  void report(benchmark::State& state) const;
};

/// 0: 384x172 as recorded, 1: 640x480 as recorded; with added noise, sigma of Y / of U and V: 2: 640x480 5/3,
/// 3: 640x480 10/6, 4: 1280x960 5/3, 5: 1920x1080 5/3. 6: 640x480 5/3 with the table's rims made ragged.
constexpr int kBenchFrames = 7;
const BenchFrames& bench_frames(int index);

}  // namespace tassilo::test
