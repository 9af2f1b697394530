#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace tassilo {

/// Pose of the robot in the odometry frame, which drifts but does not jump, at one time.
struct OdometrySample {
  double t = 0;                    ///< On the clock of the frames. [s]
  double x = 0, y = 0, theta = 0;  ///< [m, rad]
  friend bool operator==(const OdometrySample&, const OdometrySample&) = default;
};

/// The odometry pose over time, asked for at any time; the newest `capacity` samples are kept.
///
/// threads  one at a time.
class Odometry {
 public:
  static constexpr double kMaxExtrapolation = 0.1;  ///< [s]

  /// capacity >= 2; the memory is taken at once, `add` allocates nothing.
  explicit Odometry(std::size_t capacity = 4096);

  /// Takes the newest sample, forgets the oldest when full. O(1).
  /// Throws Error when a value is not finite or when the time does not increase.
  void add(const OdometrySample& sample);

  /// The pose at time t, theta in [-pi, pi). O(log capacity).
  ///
  /// Between two samples: linear, theta along the shorter way. Up to kMaxExtrapolation before the oldest or after the
  /// newest: with constant velocity over a stretch at least as long as the one extrapolated (all of the history when it
  /// is shorter), so that noise of dense samples is not blown up. Nothing further away, and nothing from one sample
  /// alone except at its own time.
  std::optional<OdometrySample> at(double t) const;

  std::size_t size() const { return size_; }
  std::size_t capacity() const { return ring_.size(); }

 private:
  const OdometrySample& sample(std::size_t i) const {
    return ring_[(first_ + i) % ring_.size()];
  }  ///< 0 is the oldest.
  std::size_t first_not_before(double t) const;

  std::vector<OdometrySample> ring_;
  std::size_t first_ = 0, size_ = 0;
};

}  // namespace tassilo
