#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <utility>

#include "tassilo/base/recycled.h"

namespace tassilo {

/// Sorts by `less` of `key`; equal values keep their order. Unlike std::stable_sort it takes its buffer from recycled
/// memory, so that it allocates nothing in steady state. O(n log n) comparisons, n moves.
template <class T, class Less = std::less<>, class Key = std::identity>
void sort_stably(RecycledVector<T>& values, Less less = {}, Key key = {}) {
  RecycledVector<std::uint32_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    if (std::invoke(less, std::invoke(key, values[a]), std::invoke(key, values[b]))) return true;
    if (std::invoke(less, std::invoke(key, values[b]), std::invoke(key, values[a]))) return false;
    return a < b;
  });
  RecycledVector<T> sorted;
  sorted.reserve(values.size());
  for (const std::uint32_t i : order) sorted.push_back(std::move(values[i]));
  values = std::move(sorted);
}

}  // namespace tassilo
