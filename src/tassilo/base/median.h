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

}  // namespace tassilo
