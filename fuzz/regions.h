#pragma once

#include <cstdint>
#include <set>
#include <utility>

#include "bytes.h"
#include "tassilo/base/kernel.h"
#include "tassilo/region/region.h"

// What targets that make regions share.

namespace tassilo {

using Pixels = std::set<std::pair<int, int>>;  // (row, column)

inline Region next_region(Bytes& bytes, int most_runs, int extent) {
  RunVector runs;
  for (int n = bytes.below(most_runs + 1); n > 0; --n) {
    const int row = bytes.below(extent) - extent / 2, begin = bytes.below(extent) - extent / 2;
    runs.push_back({static_cast<std::int16_t>(row), static_cast<std::int16_t>(begin),
                    static_cast<std::int16_t>(begin + bytes.below(extent))});
  }
  return Region::from_runs(std::move(runs));
}

inline Pixels pixels_of(const Region& region) {
  Pixels pixels;
  for (const PixelRun& run : region.runs())
    for (int c = run.begin; c < run.end; ++c) pixels.insert({run.row, c});
  return pixels;
}

inline PixelBox wider(const PixelBox& box, int margin) {
  return {box.x0 - margin, box.y0 - margin, box.x1 + margin, box.y1 + margin};
}

/// Calls check() with each kernel that this machine runs, then goes back to the one that was in use.
template <class Check>
void with_every_kernel(Check check) {
  const Kernel fastest = kernel_in_use();
  for (const Kernel kernel : supported_kernels()) {
    use_kernel(kernel);
    check();
  }
  use_kernel(fastest);
}

}  // namespace tassilo
