#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "tassilo/base/recycled.h"
#include "tassilo/geometry/box.h"

namespace tassilo {

/// One horizontal stretch of pixels: columns [begin, end) of `row`. Signed: runs may leave the image. [px]
struct PixelRun {
  std::int16_t row = 0, begin = 0, end = 0;

  int length() const { return end - begin; }
  friend auto operator<=>(const PixelRun&, const PixelRun&) = default;
};

using RunVector = RecycledVector<PixelRun>;

/// A set of pixels as runs; need not be connected, may be empty.
///
/// Invariant: runs are not empty, sorted by (row, begin), and two runs of a row neither overlap nor touch.
/// So equal sets have equal runs.
class Region {
 public:
  Region() = default;

  /// Takes runs that already keep the invariant; checked in debug builds. O(1) in release.
  static Region from_sorted(RunVector runs);
  /// Any runs: empty ones dropped, overlapping and touching ones joined. O(R log R).
  static Region from_runs(RunVector runs);
  /// All pixels of a box.
  static Region from_box(const PixelBox& box);

  std::span<const PixelRun> runs() const& { return runs_; }
  std::span<const PixelRun> runs() const&& = delete;  ///< Would outlive the runs: for (run : opening(...).runs()).
  /// Gives the runs away, so that their memory can serve the next region; the region is empty afterwards.
  RunVector take_runs() { return std::exchange(runs_, {}); }
  bool empty() const { return runs_.empty(); }
  friend bool operator==(const Region&, const Region&) = default;

 private:
  RunVector runs_;
};

/// Index behind the last run of the row of runs[first]; sorted runs. O(runs of the row).
inline std::size_t row_end(std::span<const PixelRun> runs, std::size_t first) {
  std::size_t end = first + 1;
  while (end < runs.size() && runs[end].row == runs[first].row) ++end;
  return end;
}

/// Number of pixels. O(R).
std::int64_t area(const Region& region);
/// Smallest axis-parallel box; empty for the empty region. O(R).
PixelBox bounding_box(const Region& region);
/// Is pixel (column, row) in the region? O(log R).
bool contains(const Region& region, int column, int row);

}  // namespace tassilo
