#pragma once

#include <Eigen/Core>
#include <array>

#include "tassilo/fusion/field_sighting.h"

// Where one thing is, together with the pose errors of the robots that saw it: what they err alike in all their images
// is not averaged away as if it were new each time.

namespace tassilo {

/// All of a team, or of both at a training match's bench: one more pushes out who saw the thing longest ago, and those
/// who take turns in that are believed as if their pose errors were new each time.
inline constexpr int kMaxWitnesses = 10;
inline constexpr int kMaxBeliefSize = 4 + 3 * kMaxWitnesses;

/// x, y, vx, vy of a thing in the field's axes [m, m/s], then three numbers for each witness: its pose error as
/// multiples of the standard deviations it claims, L^-1 (x, y, theta) with L the root of its pose's covariance.
struct Belief {
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxBeliefSize, 1> mean;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxBeliefSize, kMaxBeliefSize> covariance;
};

/// What a sighting says of a thing: place = thing + by_error * (the witness's three numbers) + noise.
struct Evidence {
  Eigen::Vector2d place;
  Eigen::Matrix2d noise;                 ///< Its covariance; positive definite.
  Eigen::Matrix<double, 2, 3> by_error;  ///< by_pose * L.
};

/// How things move by themselves.
struct Rolling {
  double friction = 0;      ///< Braking of what moves. [m/s^2], >= 0
  double walk = 0;          ///< Variance rate of the velocity. [(m/s)^2/s], >= 0
  double error_memory = 1;  ///< Time in which a pose error's correlation with itself falls to 1/e. [s], > 0
};

/// A thing seen once, by witness 0.
Belief begun(const Evidence& evidence, double speed_sigma);

/// The same some time later. Friction takes speed, no more than there is; where the direction is not known it counts
/// the less. Pose errors fade to what is known of a robot never met: zero, with variance 1. O(size^2).
void roll(Belief& belief, double dt, const Rolling& rolling);

/// Adds a witness of whose error nothing is known; it comes last. There must be room.
void add_witness(Belief& belief);
/// Forgets a witness; the last one takes its number.
void remove_witness(Belief& belief, int witness);
int witness_count(const Belief& belief);

/// How well evidence fits.
struct Fit {
  double squared = 0;        ///< Squared Mahalanobis distance.
  double minus_two_log = 0;  ///< -2 log of its likelihood.
};
/// witness  -1: one of whose error nothing is known
Fit fit(const Belief& belief, const Evidence& evidence, int witness);

/// Takes the evidence in: one step of a Kalman filter, in the form that keeps covariances positive (Joseph). O(size^2).
void observe(Belief& belief, const Evidence& evidence, int witness);

/// Mean and covariance of one that is a with probability 1 - share, b with share. Both of the same size.
Belief mixed(const Belief& a, const Belief& b, double share);

}  // namespace tassilo
