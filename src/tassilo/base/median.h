#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "tassilo/base/contract.h"

namespace tassilo {

/// The middle value, the upper of the two middle ones where the number is even; ordered by `key`. There must be one
/// value at least. O(n).
template <class T, class Allocator, class Key = std::identity>
T median(std::vector<T, Allocator> values, Key key = {}) {
  expects(!values.empty(), "median of one value or more");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle, {}, key);
  return *middle;
}

/// The value nearest to the share q of the way through the ordered values, 0 <= q <= 1; the median for 0.5. There must
/// be one value at least. O(n).
template <class T, class Allocator>
T quantile(std::vector<T, Allocator> values, double q) {
  expects(!values.empty() && q >= 0 && q <= 1, "quantile of one value or more");
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  std::ranges::nth_element(values, at);
  return *at;
}

}  // namespace tassilo
