#pragma once

#include <optional>

namespace tassilo {

/// What another's clock shows when ours shows something else, from stamps and when they came here.
///
/// A message takes at least no time, and the quickest of late took about as long as any: its delay, by both clocks, is
/// the difference between them. Whoever sends stamps that do not go with that is not believed; but when ten in a row,
/// over half a second, go with each other, the clock has been set, and is believed again.
class ClockOffset {
 public:
  enum class Verdict {
    plausible,
    too_old,      ///< Longer on its way than 10 s, or from before that.
    from_future,  ///< More than 1 s before the quickest: nothing is that quick.
    was_set,      ///< Plausible by the clock as it is now; what was known by the old one has other times.
  };
  Verdict judge(double stamp, double arrival);

  /// Of the other clock before ours, at least: by as much as the quickest message took it is more. Nothing before the
  /// first message. [s]
  std::optional<double> ahead() const;
  /// How much longer than the quickest one of late a message has been on its way; what judge found plausible. [s]
  double delay(double stamp, double arrival) const { return arrival - stamp - quickest(); }

 private:
  double quickest() const;
  void begin(double apparent, double arrival);

  // The quickest of this stretch of time and of the one before: what was quick long ago says little of drifting clocks.
  struct Stretch {
    double begin = 0;     ///< [s]
    double quickest = 0;  ///< Arrival after stamp, by both clocks. [s]
  };
  std::optional<Stretch> now_, before_;
  struct Other {
    double first = 0;  ///< Arrival. [s]
    double apparent = 0;
    int count = 0;
  };
  std::optional<Other> other_;  ///< Stamps that may be those of a clock that was set.
};

}  // namespace tassilo
