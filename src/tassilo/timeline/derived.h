#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/timeline/sequence.h"

namespace tassilo {

/// A value of a time that follows from sequences, or from whatever is known of that time, such as how far the robot
/// has turned in the second before. It is worked out when somebody asks, and once for all who ask, as long as no more
/// than `capacity` other times have been asked for since.
///
/// All who ask for one time get the same answer, though the sequences may have learned more in between; `clear` is for
/// those who want it anew. The function must not ask for the time that it is asked for.
///
/// threads  one at a time
template <class T>
class Derived {
 public:
  /// capacity  >= 1, how many answers are kept: a few, they are searched one by one. The memory is taken here.
  /// function  the value at a time; it may ask for other times
  Derived(std::size_t capacity, std::function<T(double t)> function)
      : capacity_(capacity), function_(std::move(function)) {
    expects(capacity >= 1, "Derived: a capacity of at least 1");
    expects(function_ != nullptr, "Derived: a function");
    answers_.reserve(capacity);
  }

  /// The value at time t. It stays where it is until `capacity` other times have been asked for, or `clear`.
  /// Throws Error when t is not finite, and what the function throws, of which nothing is kept. O(capacity).
  const T& at(double t) {
    if (!std::isfinite(t)) throw Error("derived", "t is " + std::to_string(t) + ", must be finite");
    for (const Timed<T>& answer : answers_)
      if (answer.t == t) return answer.value;
    T value = function_(t);  // It may ask for other times: what is replaced is chosen afterwards.
    if (answers_.size() < capacity_) return answers_.emplace_back(Timed<T>{t, std::move(value)}).value;
    Timed<T>& oldest = answers_[oldest_];
    oldest = {t, std::move(value)};
    oldest_ = (oldest_ + 1) % capacity_;
    return oldest.value;
  }

  /// Forgets all answers, keeps the memory.
  void clear() {
    answers_.clear();
    oldest_ = 0;
  }

  std::size_t size() const { return answers_.size(); }
  std::size_t capacity() const { return capacity_; }

 private:
  std::size_t capacity_;
  std::function<T(double t)> function_;
  std::vector<Timed<T>> answers_;
  std::size_t oldest_ = 0;  ///< Of the answers, once there are `capacity_`.
};

}  // namespace tassilo
