#include "tassilo/region/partition.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "tassilo/base/contract.h"

namespace tassilo {
namespace {

/// `length` pixels from `first` on, divided into `count` stretches that differ by at most one pixel.
struct Division {
  std::int64_t first, length, count;

  Division(int from, int pixels, int part)
      : first(from), length(pixels), count(std::max(1, (2 * pixels + part) / (2 * part))) {}

  /// Which stretch holds the pixel.
  std::int64_t at(int pixel) const { return ((pixel - first + 1) * count - 1) / length; }
  /// Pixel behind stretch k.
  int end(std::int64_t k) const { return static_cast<int>(first + (k + 1) * length / count); }
};

}  // namespace

RecycledVector<Region> partition_into_rectangles(const Region& region, PartSize size) {
  constexpr int kMost = 1 << 16;  // no region is larger; keeps the division's sums small
  expects(size.width >= 1 && size.height >= 1, "parts have at least one pixel");
  RecycledVector<Region> parts;
  if (region.empty()) return parts;
  const PixelBox box = bounding_box(region);
  const Division columns(box.x0, box.width(), std::min(size.width, kMost));
  const Division rows(box.y0, box.height(), std::min(size.height, kMost));
  RecycledVector<RunVector> cells(static_cast<std::size_t>(columns.count));
  const auto finish = [&] {
    for (RunVector& cell : cells)
      if (!cell.empty()) parts.push_back(Region::from_sorted(std::exchange(cell, {})));
  };
  int behind = rows.end(0);
  for (const PixelRun& run : region.runs()) {
    if (run.row >= behind) {
      finish();
      behind = rows.end(rows.at(run.row));
    }
    std::int64_t k = columns.at(run.begin);
    for (int begin = run.begin; begin < run.end; ++k) {
      const int end = std::min<int>(run.end, columns.end(k));
      cells[static_cast<std::size_t>(k)].push_back(
          {run.row, static_cast<std::int16_t>(begin), static_cast<std::int16_t>(end)});
      begin = end;
    }
  }
  finish();
  return parts;
}

}  // namespace tassilo
