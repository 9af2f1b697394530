#include "tassilo/app/team_history.h"

#include <algorithm>
#include <utility>

namespace tassilo {

void TeamHistory::add(double t, std::shared_ptr<const std::string> picture) {
  if (!entries_.empty() && t <= entries_.back().t) return;
  bytes_ += picture->size();
  entries_.push_back({t, std::move(picture)});
  while (entries_.size() > 1 && (bytes_ > memory_bytes_ || entries_.front().t < t - memory_s_)) {
    bytes_ -= entries_.front().picture->size();
    entries_.pop_front();
  }
}

std::shared_ptr<const std::string> TeamHistory::at(double t) const {
  const auto after = std::ranges::upper_bound(entries_, t, {}, &Entry::t);
  return after == entries_.begin() ? nullptr : std::prev(after)->picture;
}

std::optional<double> TeamHistory::begin() const {
  if (entries_.empty()) return std::nullopt;
  return entries_.front().t;
}
std::optional<double> TeamHistory::end() const {
  if (entries_.empty()) return std::nullopt;
  return entries_.back().t;
}

}  // namespace tassilo
