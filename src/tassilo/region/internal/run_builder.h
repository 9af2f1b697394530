#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "tassilo/region/region.h"

namespace tassilo {

/// Collects the runs of a region in order. Writes before it knows whether a run stays, instead of branching:
/// on noisy regions a mispredicted branch costs more than all else a run needs.
class RunBuilder {
 public:
  /// At most `capacity` runs may be added.
  explicit RunBuilder(std::size_t capacity) : runs_(capacity + 2) {}

  /// Adds a run that begins nowhere before the last one; joins the two where they overlap or touch.
  void add_joined(const PixelRun& run) {
    const PixelRun& last = runs_[size_];
    const bool joins = (size_ > 0) & (last.row == run.row) & (run.begin <= last.end);
    const PixelRun joined{run.row, joins ? last.begin : run.begin, joins ? std::max(last.end, run.end) : run.end};
    size_ += !joins;
    runs_[size_] = joined;
  }
  /// Adds a run that begins behind the last one and does not touch it; an empty one is left out.
  void add_if_not_empty(const PixelRun& run) {
    runs_[size_ + 1] = run;
    size_ += run.begin < run.end;
  }
  Region region() && {
    runs_.resize(size_ + 1);
    runs_.erase(runs_.begin());
    return Region::from_sorted(std::move(runs_));
  }

 private:
  RunVector runs_;  ///< First a place holder to compare the first run with, last room for one left out.
  std::size_t size_ = 0;
};

}  // namespace tassilo
