#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace tassilo {

/// How much came in a second, over the last two: of messages, of bytes. Times must not go back by much.
class RateMeter {
 public:
  void add(double t, double amount) {
    Share& share = share_of(t);
    share.amount += amount;
  }
  /// What came in the last kWindow, but for the fifth of a second at work, by the time it came in.
  double per_second(double now) const {
    const std::int64_t at_work = index_of(now);
    double sum = 0;
    for (const Share& share : shares_)
      if (share.index < at_work && share.index >= at_work - kShares) sum += share.amount;
    return sum / (kShares * kShare);
  }

 private:
  struct Share {
    std::int64_t index = -1000;
    double amount = 0;
  };
  static constexpr std::int64_t kShares = 10;
  static constexpr double kShare = 0.2;  ///< [s]
  static std::int64_t index_of(double t) { return static_cast<std::int64_t>(std::floor(t / kShare)); }
  Share& share_of(double t) {
    const std::int64_t index = index_of(t);
    Share& share = shares_.at(static_cast<std::size_t>(((index % (kShares + 1)) + kShares + 1) % (kShares + 1)));
    if (share.index != index) share = {index, 0};
    return share;
  }
  std::array<Share, kShares + 1> shares_;
};

}  // namespace tassilo
