#include "tassilo/team/clock_offset.h"

#include <algorithm>
#include <cmath>

namespace tassilo {
namespace {

constexpr double kStretch = 10;     // crystals drift by less than a millisecond meanwhile [s]
constexpr double kSlowest = 10;     // later, a message is of no use to anybody [s]
constexpr double kQuicker = 1;      // than the quickest; a link does not change so much for the better [s]
constexpr double kAgree = 1;        // stamps of one clock differ by what the link adds [s]
constexpr int kWitnesses = 10;      // messages
constexpr double kTestimony = 0.5;  // [s]

}  // namespace

double ClockOffset::quickest() const {
  return before_ ? std::min(before_->quickest, now_->quickest) : now_ ? now_->quickest : 0;
}

std::optional<double> ClockOffset::ahead() const {
  if (!now_) return std::nullopt;
  return -quickest();
}

void ClockOffset::begin(double apparent, double arrival) {
  now_ = Stretch{arrival, apparent};
  before_.reset();
  other_.reset();
}

ClockOffset::Verdict ClockOffset::judge(double stamp, double arrival) {
  const double apparent = arrival - stamp;
  if (!now_) {
    begin(apparent, arrival);
    return Verdict::plausible;
  }
  const double more = apparent - quickest();
  if (more >= -kQuicker && more <= kSlowest) {
    other_.reset();
    if (arrival > now_->begin + kStretch) {
      before_ = now_;
      now_ = Stretch{arrival, apparent};
    }
    now_->quickest = std::min(now_->quickest, apparent);
    return Verdict::plausible;
  }
  if (!other_ || std::abs(apparent - other_->apparent) > kAgree) other_ = Other{arrival, apparent, 0};
  if (++other_->count >= kWitnesses && arrival - other_->first >= kTestimony) {
    begin(apparent, arrival);
    return Verdict::was_set;
  }
  return more > 0 ? Verdict::too_old : Verdict::from_future;
}

}  // namespace tassilo
