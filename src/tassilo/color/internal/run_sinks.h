#pragma once

#include <array>
#include <cstdint>

#include "tassilo/base/recycled.h"
#include "tassilo/color/internal/color_kernel.h"
#include "tassilo/color/segment.h"

namespace tassilo {

/// Collects the runs of all classes of a label image, row by row from the top.
///
/// Writes first and asks later, so that noise costs no mispredicted branches.
class RunSinks {
 public:
  /// For rows of segmentation.width pixels; the regions it has say how many runs to expect.
  explicit RunSinks(const Segmentation& segmentation);

  /// Where a kernel writes the runs of a row, for `add_row`.
  RowRuns row_runs() { return {begin_.data(), end_.data(), label_.data()}; }
  /// The first `count` runs there are those of row r.
  void add_row(int r, int count);
  /// Puts the regions in place; their memory is used again.
  void finish(Segmentation& segmentation) &&;

 private:
  void make_room(std::size_t k);

  int width_ = 0;
  // By label - 1:
  std::array<RecycledBuffer<PixelRun>, kColorClassCount> runs_;
  std::array<PixelRun*, kColorClassCount> end_of_{};    ///< Behind the last run.
  std::array<PixelRun*, kColorClassCount> limit_of_{};  ///< Up to here there is room for the runs of a row.
  RecycledBuffer<std::uint16_t> begin_, end_;           ///< Of the row at work.
  RecycledBuffer<std::uint8_t> label_;
};

}  // namespace tassilo
