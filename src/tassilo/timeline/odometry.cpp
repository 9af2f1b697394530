#include "tassilo/timeline/odometry.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

/// On the straight line through a and b at time t, possibly outside of them.
OdometrySample on_line(const OdometrySample& a, const OdometrySample& b, double t) {
  const double s = (t - a.t) / (b.t - a.t);
  return {t, a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), wrap_angle(a.theta + s * wrap_angle(b.theta - a.theta))};
}

}  // namespace

Odometry::Odometry(std::size_t capacity) : ring_(capacity) {
  expects(capacity >= 2, "Odometry: a capacity of at least 2");
}

void Odometry::add(const OdometrySample& added) {
  for (const double value : {added.t, added.x, added.y, added.theta})
    if (!std::isfinite(value)) throw Error("odometry", "a value is not finite");
  if (size_ > 0 && !(added.t > sample(size_ - 1).t)) {
    std::ostringstream reason;
    reason.precision(16);
    reason << "t is " << added.t << ", must be later than the sample before, " << sample(size_ - 1).t;
    throw Error("odometry", reason.str());
  }
  if (size_ < ring_.size()) {
    ring_[(first_ + size_++) % ring_.size()] = added;
  } else {
    ring_[first_] = added;
    first_ = (first_ + 1) % ring_.size();
  }
}

std::size_t Odometry::first_not_before(double t) const {
  std::size_t low = 0, high = size_;
  while (low < high) {
    const std::size_t middle = low + (high - low) / 2;
    if (sample(middle).t < t)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

std::optional<OdometrySample> Odometry::at(double t) const {
  if (size_ == 0 || !std::isfinite(t)) return std::nullopt;
  const std::size_t next = first_not_before(t);
  if (next < size_ && sample(next).t == t) {
    OdometrySample exact = sample(next);
    exact.theta = wrap_angle(exact.theta);
    return exact;
  }
  if (size_ < 2) return std::nullopt;
  const std::size_t last = size_ - 1;
  if (next == 0) {
    const double ahead = sample(0).t - t;
    if (ahead > kMaxExtrapolation) return std::nullopt;
    const std::size_t base = std::clamp<std::size_t>(first_not_before(sample(0).t + ahead), 1, last);
    return on_line(sample(0), sample(base), t);
  }
  if (next == size_) {
    const double beyond = t - sample(last).t;
    if (beyond > kMaxExtrapolation) return std::nullopt;
    const double base_time = sample(last).t - beyond;
    std::size_t base = first_not_before(base_time);
    if (base > 0 && sample(base).t > base_time) --base;
    return on_line(sample(last), sample(std::min(base, last - 1)), t);
  }
  return on_line(sample(next - 1), sample(next), t);
}

}  // namespace tassilo
