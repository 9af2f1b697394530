#pragma once

#include <Eigen/Core>

#include <cmath>

#include "tassilo/base/recycled.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {

/// A pose of the robot on the field with its covariance.
struct PoseGaussian {
  double x = 0, y = 0, theta = 0;                            ///< Field frame. [m, rad]
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< Of x, y, theta.

  FieldFromRobot field_from_robot() const { return make_pose2<FieldFrame, RobotFrame>(x, y, theta); }
};

/// With uncertainties that do not depend on each other. [m, rad]
inline PoseGaussian pose_gaussian(double x, double y, double theta, double sigma_xy, double sigma_theta) {
  PoseGaussian pose{x, y, theta, Eigen::Matrix3d::Zero()};
  pose.covariance.diagonal() << sigma_xy * sigma_xy, sigma_xy * sigma_xy, sigma_theta * sigma_theta;
  return pose;
}

/// Are both less than `distance` apart, and turned by less than `turn`? [m, rad]
inline bool are_near(const PoseGaussian& a, const PoseGaussian& b, double distance, double turn) {
  return std::hypot(a.x - b.x, a.y - b.y) < distance && std::abs(wrap_angle(a.theta - b.theta)) < turn;
}

/// One place where the robot may be.
struct PoseHypothesis {
  PoseGaussian pose;
  double log_weight = 0;  ///< Relative to the best one's 0.
};

/// What is known of the pose at one time: where it may be, most likely first; empty while unknown.
struct PoseBelief {
  double t = 0;  ///< [s]
  RecycledVector<PoseHypothesis> hypotheses;
  double fixed_at = 0;  ///< When the best one was last tied to the field. [s]
  bool tied = false;    ///< Was the field ever seen from where it was told? Then the mount is as known.
  bool told = false;    ///< One place, or it and its mirror, were sure enough to be told.
  int doubts = 0;       ///< Frames in a row, or nearly so, that the best one did not explain.
};

/// Share of the belief that the most likely place holds, 0 while there is none.
inline double share_of_best(const PoseBelief& belief) {
  double all = 0;
  for (const PoseHypothesis& one : belief.hypotheses) all += std::exp(one.log_weight);
  return all > 0 ? std::exp(belief.hypotheses.front().log_weight) / all : 0;
}

}  // namespace tassilo
