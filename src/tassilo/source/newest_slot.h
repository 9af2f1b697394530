#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>

namespace tassilo {

/// Where a thread that must not wait leaves values for one that may be slow: it holds the newest one only.
///
/// An older value that nobody took is dropped and counted, never queued: what is taken is as fresh as can be. Every
/// value that was put is taken, dropped or still there.
///
/// threads  any; `put` never waits for the taker
template <class T>
class NewestSlot {
 public:
  void put(T value) {
    std::optional<T> older;  // Ends after the lock: to let go of a frame may take a system call.
    {
      const std::lock_guard lock(mutex_);
      older = std::exchange(value_, std::optional<T>(std::move(value)));
      replaced_ += older.has_value();
    }
    filled_.notify_one();
  }

  /// The newest value, which is no longer in the slot; nothing when none came within `patience`.
  std::optional<T> take(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    filled_.wait_for(lock, patience, [&] { return value_.has_value(); });
    return std::exchange(value_, std::nullopt);
  }

  /// How many values were dropped for a newer one.
  std::int64_t replaced() const {
    const std::lock_guard lock(mutex_);
    return replaced_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable filled_;
  std::optional<T> value_;
  std::int64_t replaced_ = 0;
};

}  // namespace tassilo
