#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tassilo/evaluate/evaluate.h"

namespace tassilo {

using Numbers = std::vector<double>;

/// How often something held.
struct Tally {
  std::int64_t held = 0, count = 0;

  void add(bool holds) {
    held += holds;
    ++count;
  }
  std::optional<double> share() const;
  friend Tally operator+(Tally a, Tally b) { return {a.held + b.held, a.count + b.count}; }
};

std::optional<double> ratio(std::int64_t part, std::int64_t whole);
std::optional<double> mean(const Numbers& values);
/// Linear interpolation between neighbors; nothing where these are not finite.
std::optional<double> quantile(Numbers values, double q);
std::optional<double> maximum(const Numbers& values);
Spread spread(const Numbers& values);

}  // namespace tassilo
