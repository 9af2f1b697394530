#include "tassilo/region/region.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "tassilo/base/contract.h"
#include "tassilo/region/internal/coordinate.h"
#include "tassilo/region/internal/run_builder.h"

namespace tassilo {
namespace {

[[maybe_unused]] bool keeps_invariant(std::span<const PixelRun> runs) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].begin >= runs[i].end) return false;
    if (i == 0) continue;
    const PixelRun &before = runs[i - 1], &run = runs[i];
    if (run.row < before.row || (run.row == before.row && run.begin <= before.end)) return false;
  }
  return true;
}

}  // namespace

Region Region::from_sorted(RunVector runs) {
#ifndef NDEBUG
  expects(keeps_invariant(runs), "runs sorted, disjoint, not touching, not empty");
#endif
  Region region;
  region.runs_ = std::move(runs);
  return region;
}

Region Region::from_runs(RunVector runs) {
  std::erase_if(runs, [](const PixelRun& run) { return run.begin >= run.end; });
  std::ranges::sort(runs);
  RunBuilder result(runs.size());
  for (const PixelRun& run : runs) result.add_joined(run);
  return std::move(result).region();
}

Region Region::from_box(const PixelBox& box) {
  RunVector runs;
  if (!box.empty()) {
    runs.reserve(static_cast<std::size_t>(box.height()));
    for (int r = box.y0; r < box.y1; ++r)
      runs.push_back({to_coordinate(r), to_coordinate(box.x0), to_coordinate(box.x1)});
  }
  return from_sorted(std::move(runs));
}

std::int64_t area(const Region& region) {
  std::int64_t sum = 0;
  for (const PixelRun& run : region.runs()) sum += run.length();
  return sum;
}

PixelBox bounding_box(const Region& region) {
  const auto runs = region.runs();
  if (runs.empty()) return {};
  // Eight runs at a time as a row of numbers, of which every third is a begin, the next one an end.
  constexpr std::size_t kRuns = 8;
  std::array<std::int16_t, 3 * kRuns> least, most, numbers;
  static_assert(sizeof(PixelRun) * kRuns == sizeof numbers);
  least.fill(std::numeric_limits<std::int16_t>::max());
  most.fill(std::numeric_limits<std::int16_t>::min());
  std::size_t k = 0;
  for (; k + kRuns <= runs.size(); k += kRuns) {
    std::memcpy(numbers.data(), runs.data() + k, sizeof numbers);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      least[i] = std::min(least[i], numbers[i]);
      most[i] = std::max(most[i], numbers[i]);
    }
  }
  PixelBox box{std::numeric_limits<int>::max(), runs.front().row, std::numeric_limits<int>::min(), runs.back().row + 1};
  for (std::size_t i = 0; k >= kRuns && i < kRuns; ++i) {
    box.x0 = std::min<int>(box.x0, least[3 * i + 1]);
    box.x1 = std::max<int>(box.x1, most[3 * i + 2]);
  }
  for (; k < runs.size(); ++k) {
    box.x0 = std::min<int>(box.x0, runs[k].begin);
    box.x1 = std::max<int>(box.x1, runs[k].end);
  }
  return box;
}

bool contains(const Region& region, int column, int row) {
  const auto runs = region.runs();
  // The first run that ends beyond the pixel is the only one that can hold it.
  const auto it = std::ranges::partition_point(
      runs, [&](const PixelRun& run) { return run.row < row || (run.row == row && run.end <= column); });
  return it != runs.end() && it->row == row && it->begin <= column;
}

}  // namespace tassilo
