#include "tassilo/region/relation.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>

namespace tassilo {
namespace {

/// Calls visit(n) for each stretch of n pixels in both, until it says stop (true).
template <class Visit>
void for_each_common(const Region& first, const Region& second, Visit visit) {
  const auto a = first.runs(), b = second.runs();
  if (a.empty() || b.empty()) return;
  const auto begin = [](std::span<const PixelRun> runs, std::int16_t row) {
    return static_cast<std::size_t>(std::ranges::lower_bound(runs, row, {}, &PixelRun::row) - runs.begin());
  };
  std::size_t ia = begin(a, b.front().row), ib = begin(b, a.front().row);
  while (ia < a.size() && ib < b.size()) {
    const PixelRun &run_a = a[ia], &run_b = b[ib];
    const int common = std::min(run_a.end, run_b.end) - std::max(run_a.begin, run_b.begin);
    if (run_a.row == run_b.row && common > 0 && visit(common)) return;
    const bool a_ends_first = std::tie(run_a.row, run_a.end) < std::tie(run_b.row, run_b.end);
    ia += a_ends_first;
    ib += !a_ends_first;
  }
}

}  // namespace

std::int64_t common_area(const Region& a, const Region& b) {
  std::int64_t sum = 0;
  for_each_common(a, b, [&](int common) {
    sum += common;
    return false;
  });
  return sum;
}

bool overlaps(const Region& a, const Region& b) {
  bool found = false;
  for_each_common(a, b, [&](int) { return found = true; });
  return found;
}

bool is_subset(const Region& inner, const Region& outer) { return common_area(inner, outer) == area(inner); }

std::int64_t hamming_distance(const Region& a, const Region& b) { return area(a) + area(b) - 2 * common_area(a, b); }

double intersection_over_union(const Region& a, const Region& b) {
  const std::int64_t both = common_area(a, b), any = area(a) + area(b) - both;
  return any > 0 ? static_cast<double>(both) / static_cast<double>(any) : 0;
}

}  // namespace tassilo
