#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"

namespace tassilo {

/// What a type knows of the time between and beside its values. Specialize it for a type whose sequences are asked for
/// values `at` a time; there is no general answer. As for a length in metres:
///
///     template <>
///     struct Interpolation<Length> {
///       static constexpr double kMaxGap = 1;              ///< [s], >= 0
///       static constexpr double kMaxExtrapolation = 0.1;  ///< [s], >= 0, at most half of kMaxGap
///       static Length between(const Length& a, const Length& b, double share) { return a + share * (b - a); }
///     };
///
/// kMaxGap            values further apart in time say nothing of what was between them
/// kMaxExtrapolation  how far before the first and after the last value of a stretch without gap it is known, too
/// between            the value where `share` of the time from a to b has passed: a at 0, b at 1, by extrapolation
///                    where it is outside of them
template <class T>
struct Interpolation;

template <class T>
concept Interpolated = requires(const T& value, double share) {
  { Interpolation<T>::between(value, value, share) } -> std::convertible_to<T>;
  { Interpolation<T>::kMaxGap } -> std::convertible_to<double>;
  { Interpolation<T>::kMaxExtrapolation } -> std::convertible_to<double>;
};

/// A value and when it was so. [s]
template <class T>
struct Timed {
  double t = 0;
  T value{};
};

/// Where a value went.
enum class Added {
  newest,     ///< Behind all others, as values that come in order do.
  inserted,   ///< Among or before the others: it came out of order.
  duplicate,  ///< Nowhere: there is a value of this time, and the first one stays.
  too_late,   ///< Nowhere: it is older than all of a full history.
};

/// What came to a sequence since it was made or cleared. All that came: added + duplicates + too_late.
struct SequenceCounts {
  std::int64_t added = 0;         ///< Taken, whether kept until now or not; those out of order, too.
  std::int64_t out_of_order = 0;  ///< Of those added.
  std::int64_t duplicates = 0, too_late = 0;
  friend bool operator==(const SequenceCounts&, const SequenceCounts&) = default;
};

/// The values of one quantity over time, by time, each time once: the newest `capacity` of all that came, in whatever
/// order they came. T is a default-constructible type that can be moved.
///
/// Pointers and references to values hold until the next `add` or `clear`. Searches take O(log size).
///
/// threads  one at a time; several may ask while nobody adds
template <class T>
class Sequence {
 public:
  /// capacity >= 1. All memory is taken here; `add` and `clear` neither take nor give back any beyond what T does.
  explicit Sequence(std::size_t capacity) : ring_(capacity) {
    expects(capacity >= 1, "Sequence: a capacity of at least 1");
  }

  /// Puts a value at its place in time; when full, the oldest one is forgotten for it. O(1) for the newest value and
  /// for the oldest, else as many moves as there are values to the nearer end. Throws Error when t is not finite.
  Added add(double t, T value) {
    if (!std::isfinite(t)) throw Error("sequence", "t is " + std::to_string(t) + ", must be finite");
    std::size_t place = first_not_before(t);
    if (place < size_ && (*this)[place].t == t) {
      ++counts_.duplicates;
      return Added::duplicate;
    }
    if (size_ == capacity()) {
      if (place == 0) {
        ++counts_.too_late;
        return Added::too_late;
      }
      first_ = slot(1);
      --size_;
      --place;
    }
    const bool newest = place == size_;
    if (place < size_ - place) {  // The free slot comes from before the oldest value, or from behind the newest.
      first_ = slot(capacity() - 1);
      for (std::size_t i = 0; i < place; ++i) ring_[slot(i)] = std::move(ring_[slot(i + 1)]);
    } else {
      for (std::size_t i = size_; i > place; --i) ring_[slot(i)] = std::move(ring_[slot(i - 1)]);
    }
    ++size_;
    ring_[slot(place)] = {t, std::move(value)};
    ++counts_.added;
    if (newest) return Added::newest;
    ++counts_.out_of_order;
    return Added::inserted;
  }

  /// Forgets all values and counts, keeps the memory.
  void clear() {
    first_ = size_ = 0;
    counts_ = {};
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t capacity() const { return ring_.size(); }
  const SequenceCounts& counts() const { return counts_; }

  /// i < size(); 0 is the oldest.
  const Timed<T>& operator[](std::size_t i) const { return ring_[slot(i)]; }

  /// The newest value; null when empty.
  const Timed<T>* latest() const { return up_to(size_); }
  /// The newest value older than t; null when there is none, or t is NaN.
  const Timed<T>* before(double t) const { return up_to(first_not_before(t)); }
  /// The newest value not newer than t; null when there is none, or t is NaN.
  const Timed<T>* at_or_before(double t) const {
    const std::size_t next = first_not_before(t);
    return up_to(next < size_ && (*this)[next].t == t ? next + 1 : next);
  }

  /// The value at time t; nothing where that is not known.
  ///
  /// At a value's own time the value. Between two values no more than kMaxGap apart, between them. Up to
  /// kMaxExtrapolation before the first and after the last value, and likewise into a gap from both of its sides: as
  /// the values go over a stretch at least as long as the one extrapolated (all there is up to a gap when that is
  /// shorter), so that noise of dense values is not blown up. From one value alone nothing follows but the value
  /// itself. So a value that comes after a gap changes no answer that was given before it came.
  std::optional<T> at(double t) const requires Interpolated<T> {
    static_assert(2 * Interpolation<T>::kMaxExtrapolation <= Interpolation<T>::kMaxGap,
                  "one side of a gap knows a time");
    if (!std::isfinite(t)) return std::nullopt;
    const std::size_t next = first_not_before(t);
    if (next < size_ && (*this)[next].t == t) return (*this)[next].value;
    if (next > 0 && next < size_ && !gap_before(next)) return between(next - 1, next, t);
    if (next > 0 && t - (*this)[next - 1].t <= Interpolation<T>::kMaxExtrapolation) return later_than(next - 1, t);
    if (next < size_ && (*this)[next].t - t <= Interpolation<T>::kMaxExtrapolation) return earlier_than(next, t);
    return std::nullopt;
  }

 private:
  /// Where value i is, for i <= capacity().
  std::size_t slot(std::size_t i) const {
    const std::size_t place = first_ + i;
    return place < capacity() ? place : place - capacity();
  }
  const Timed<T>* up_to(std::size_t end) const { return end > 0 ? &(*this)[end - 1] : nullptr; }

  /// The first value that is not older than t, size() when all are; 0 for NaN.
  std::size_t first_not_before(double t) const {
    if (size_ > 0 && (*this)[size_ - 1].t < t) return size_;
    std::size_t low = 0, high = size_;
    while (low < high) {
      const std::size_t middle = low + (high - low) / 2;
      if ((*this)[middle].t < t)
        low = middle + 1;
      else
        high = middle;
    }
    return low;
  }

  /// Is there a gap before value i > 0?
  bool gap_before(std::size_t i) const requires Interpolated<T> {
    return (*this)[i].t - (*this)[i - 1].t > Interpolation<T>::kMaxGap;
  }
  T between(std::size_t a, std::size_t b, double t) const requires Interpolated<T> {
    const Timed<T>& from = (*this)[a];
    const Timed<T>& to = (*this)[b];
    return Interpolation<T>::between(from.value, to.value, (t - from.t) / (to.t - from.t));
  }
  /// Extrapolates from value `last` to the later time t. Values in between base and `last` are too near for gaps.
  std::optional<T> later_than(std::size_t last, double t) const requires Interpolated<T> {
    if (last == 0) return std::nullopt;
    const double base_time = (*this)[last].t - (t - (*this)[last].t);
    std::size_t base = first_not_before(base_time);
    if (base > 0 && (*this)[base].t > base_time) --base;
    base = std::min(base, last - 1);
    if (gap_before(base + 1)) ++base;
    if (base == last) return std::nullopt;
    return between(last, base, t);
  }
  /// Extrapolates from value `first` to the earlier time t.
  std::optional<T> earlier_than(std::size_t first, double t) const requires Interpolated<T> {
    if (first + 1 >= size_) return std::nullopt;
    std::size_t base = first_not_before((*this)[first].t + ((*this)[first].t - t));
    base = std::clamp(base, first + 1, size_ - 1);
    if (gap_before(base)) --base;
    if (base == first) return std::nullopt;
    return between(first, base, t);
  }

  std::vector<Timed<T>> ring_;
  std::size_t first_ = 0, size_ = 0;  ///< Values are at slot(0) to slot(size_ - 1).
  SequenceCounts counts_;
};

}  // namespace tassilo
