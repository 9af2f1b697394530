#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace tassilo {

/// The median of what came within the last second: one slow frame does not move it, and what has ended is forgotten.
///
/// threads  one at a time
class RecentMedian {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `now` does not go back. Keeps the newest 1000 values.
  void add(double value, Time now) {
    constexpr std::size_t most = 1000;
    forget(now);
    if (values_.size() == most) values_.pop_front();
    values_.push_back({now, value});
  }

  /// Nothing when none came within the last second. The lower one of two in the middle.
  std::optional<double> get(Time now) {
    forget(now);
    if (values_.empty()) return std::nullopt;
    std::vector<double> sorted;
    for (const Entry& entry : values_) sorted.push_back(entry.value);
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
  }

 private:
  struct Entry {
    Time at;
    double value;
  };
  void forget(Time now) {
    while (!values_.empty() && now - values_.front().at > std::chrono::seconds(1)) values_.pop_front();
  }

  std::deque<Entry> values_;
};

}  // namespace tassilo
