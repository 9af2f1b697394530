#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

#include "tassilo/region/region.h"

namespace tassilo {

/// Walks two rows of runs together, whatever their row numbers: calls visit(column, in_a, in_b) by rising column
/// wherever being in a or in b changes; the flags hold from that column on. O(|a| + |b|).
template <class Visit>
void sweep_rows(std::span<const PixelRun> a, std::span<const PixelRun> b, Visit visit) {
  constexpr int kNever = std::numeric_limits<int>::max();
  std::size_t ia = 0, ib = 0;
  bool in_a = false, in_b = false;
  const auto next = [](std::span<const PixelRun> runs, std::size_t i, bool inside) -> int {
    if (i == runs.size()) return kNever;
    return inside ? runs[i].end : runs[i].begin;
  };
  int at_a = next(a, ia, in_a), at_b = next(b, ib, in_b);
  while (at_a != kNever || at_b != kNever) {
    const int column = std::min(at_a, at_b);
    if (at_a == column) {
      ia += in_a;
      in_a = !in_a;
      at_a = next(a, ia, in_a);
    }
    if (at_b == column) {
      ib += in_b;
      in_b = !in_b;
      at_b = next(b, ib, in_b);
    }
    visit(column, in_a, in_b);
  }
}

}  // namespace tassilo
