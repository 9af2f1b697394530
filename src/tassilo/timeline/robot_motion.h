#pragma once

#include <Eigen/Core>

#include "tassilo/timeline/odometry.h"

namespace tassilo {

/// How sure it is what a robot did between two times. One standard deviation each.
struct MotionOptions {
  /// Odometry: how far off it may be.
  double odometry_distance_sigma = 0.1;  ///< Of the distance driven: slip and a wrong wheel radius. [1], >= 0
  double odometry_turn_sigma = 0.1;      ///< Of the angle turned. [1], >= 0
  double odometry_drift_sigma = 0.01;    ///< Whatever it says, by time. [m/sqrt(s), rad/sqrt(s)], > 0
  /// Without odometry: how fast a robot may be.
  double speed_sigma = 1;        ///< [m/s], > 0
  double turn_rate_sigma = 1.5;  ///< [rad/s], > 0
  void check() const;            ///< Throws Error naming the first field out of range.
};

/// How the robot moved between two times, in its frame at the first, and how sure that is.
struct RobotMotion {
  double x = 0, y = 0, theta = 0;                        ///< [m, rad]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< Of x, y, theta.
  /// By odometry; else the covariance is that of a robot that may have driven, at a speed that hardly changes from one
  /// frame to the next.
  bool is_measured = true;
};

/// By odometry where it knows both times, else standing still with the uncertainty of a robot that may drive.
///
/// odometry   null where there is none
/// to         not before `from`, else no time passes
/// cost       two searches in the history; safe from any thread while nobody adds to the odometry
RobotMotion robot_motion(const Odometry* odometry, double from, double to, const MotionOptions& options);

}  // namespace tassilo
