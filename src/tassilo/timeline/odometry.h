#pragma once

#include <cstddef>
#include <optional>

#include "tassilo/timeline/sequence.h"

namespace tassilo {

/// Pose of the robot in the odometry frame, which drifts but does not jump, at one time.
struct OdometrySample {
  double t = 0;                    ///< On the clock of the frames. [s]
  double x = 0, y = 0, theta = 0;  ///< [m, rad]
  friend bool operator==(const OdometrySample&, const OdometrySample&) = default;
};

/// The pose of an OdometrySample.
struct OdometryPose {
  double x = 0, y = 0, theta = 0;  ///< theta: any turns. [m, rad]
};

template <>
struct Interpolation<OdometryPose> {
  /// Theta goes the shorter way, which is the robot's own while it turns by less than half a turn: for 1 s up to
  /// 3 rad/s, twice what is taken as one standard deviation of a robot without odometry. And a straight line is right
  /// within a gap^2 / 8 for an acceleration a: 0.25 m for 2 m/s^2, still about a robot's radius. [s]
  static constexpr double kMaxGap = 1;
  static constexpr double kMaxExtrapolation = 0.1;  ///< [s]
  /// On a straight line with constant velocity; theta not wrapped.
  static OdometryPose between(const OdometryPose& a, const OdometryPose& b, double share);
};

/// The odometry pose over time, asked for at any time; the newest `capacity` samples are kept, in whatever order they
/// came.
///
/// threads  one at a time; several may ask while nobody adds
class Odometry {
 public:
  static constexpr double kMaxGap = Interpolation<OdometryPose>::kMaxGap;                      ///< [s]
  static constexpr double kMaxExtrapolation = Interpolation<OdometryPose>::kMaxExtrapolation;  ///< [s]

  /// capacity >= 2; the memory is taken at once, `add` allocates nothing.
  explicit Odometry(std::size_t capacity = 4096);

  /// Takes a sample to its place in time, forgets the oldest when full. Of samples of one time the first one stays;
  /// what is older than all of a full history is dropped: `counts` tells. O(1) for samples in order, else as many moves
  /// as there are samples to the nearer end.
  /// Throws Error when a value is not finite.
  Added add(const OdometrySample& sample);

  /// The pose at time t, theta in [-pi, pi). O(log capacity).
  ///
  /// Between two samples no more than kMaxGap apart: linear, theta along the shorter way. Up to kMaxExtrapolation
  /// before the oldest or after the newest, and into a longer gap from both of its sides: with constant velocity over a
  /// stretch at least as long as the one extrapolated (all up to a gap when that is shorter), so that noise of dense
  /// samples is not blown up. Nothing further away, and nothing from one sample alone except at its own time.
  std::optional<OdometrySample> at(double t) const;

  /// As it came; i < size(), 0 is the oldest.
  OdometrySample operator[](std::size_t i) const {
    const Timed<OdometryPose>& pose = poses_[i];
    return {pose.t, pose.value.x, pose.value.y, pose.value.theta};
  }
  std::size_t size() const { return poses_.size(); }
  std::size_t capacity() const { return poses_.capacity(); }
  const SequenceCounts& counts() const { return poses_.counts(); }

 private:
  Sequence<OdometryPose> poses_;
};

}  // namespace tassilo
