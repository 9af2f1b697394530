#include "tassilo/evaluate/internal/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tassilo {

std::optional<double> ratio(std::int64_t part, std::int64_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

std::optional<double> Tally::share() const { return ratio(held, count); }

std::optional<double> mean(const Numbers& values) {
  if (values.empty()) return std::nullopt;
  return std::accumulate(values.begin(), values.end(), 0.) / static_cast<double>(values.size());
}

std::optional<double> quantile(Numbers values, double q) {
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  const double position = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const double low = values[below], high = values[std::min(below + 1, values.size() - 1)];
  // Not finite as soon as one of both is not, even when it has no weight, as numpy has it.
  const double value = low + (high - low) * (position - static_cast<double>(below));
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<double> maximum(const Numbers& values) {
  if (values.empty()) return std::nullopt;
  return *std::ranges::max_element(values);
}

Spread spread(const Numbers& values) {
  return {quantile(values, .5), quantile(values, .9), maximum(values), static_cast<std::int64_t>(values.size())};
}

}  // namespace tassilo
