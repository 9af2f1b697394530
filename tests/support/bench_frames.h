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

  /// The denominator of all figures: one table lookup a pixel pair & one mask a pixel, a plain loop.
  void scalar_reference(const Frame& frame) const;
  /// The other yardstick: memcpy of the frame, which varies with what is in the caches.
  void copy(const Frame& frame) const;
  /// Time of the scalar reference on these frames, measured once in this process. [s]
  double reference_seconds() const;
  /// Label, pixels a second, and `x_reference`: the counter `us` of `measure` as a part of the scalar reference's.
  void report(benchmark::State& state) const;
};

/// 0, 1: recordings at 384x172 and 640x480, their own noise, their trained tables. 2 .. 5: a painted scene of all eight
/// classes at 384x172, 640x480, 1280x960, 1920x1080 with noise of sigma 5 (Y) and 3 (U, V). 6: 640x480 with 10 and 6.
/// 7: as 3, with a table as ragged as one painted by hand. 8: recording 1 with noise of 5 and 3 added and trained for.
constexpr int kBenchFrames = 9;
const BenchFrames& bench_frames(int index);

}  // namespace tassilo::test
