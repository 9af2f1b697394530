#pragma once

#include <Eigen/Core>

#include "tassilo/geometry/point.h"
#include "tassilo/scene/scene.h"

namespace tassilo {

/// Where a thing seen by a robot is on the field, and how far it may be off for which reason. What the sighting adds is
/// new in every image; what the pose adds is the same for all things in the image, and nearly so in the next images.
struct FieldSighting {
  FieldPoint place;
  Eigen::Matrix2d own = Eigen::Matrix2d::Zero();                    ///< Of the sighting, in the field's axes. [m^2]
  Eigen::Matrix<double, 2, 3> by_pose = decltype(by_pose)::Zero();  ///< Derivative of place by the pose x, y, theta.
};

/// A point in the robot's frame on the field: R p + t, to first order in the pose's error, whose heading has the
/// point's distance for a lever. The pose's covariance is not looked at.
FieldSighting on_field(const PoseSeen& pose, const Gaussian2<RobotFrame>& seen);

/// All that may be off in one: own + by_pose * covariance of the pose * by_pose^T.
Gaussian2<FieldFrame> gaussian(const FieldSighting& sighting, const PoseSeen& pose);

/// L with L L^T = covariance, lower triangular, not negative on the diagonal; it changes smoothly with the covariance.
/// Of a matrix that is no covariance (a negative eigenvalue, not symmetric) what is left when the wrong parts are taken
/// for zero. All finite.
Eigen::Matrix3d square_root(const Eigen::Matrix3d& covariance);

}  // namespace tassilo
