#pragma once

#include <ceres/problem.h>

#include <Eigen/Core>
#include <array>
#include <vector>

#include "tassilo/calibrate/mount_from_target.h"
#include "tassilo/camera/mount.h"

namespace tassilo {

inline constexpr int kMountCount = 6;
/// x, y, z, roll, pitch, yaw.
using MountVector = std::array<double, kMountCount>;
CameraMount mount_from(const double* vector);
MountVector vector_from(const CameraMount& mount);

/// The mount of a camera whose optical frame is turned and placed like this in the robot frame; pitch within a quarter
/// turn.
CameraMount mount_at(const Eigen::Matrix3d& robot_from_optical, const Eigen::Vector3d& center);

/// Roots of the diagonal.
MountSigma sigma_of(const Eigen::Matrix<double, 6, 6>& covariance);

/// Root mean square of `floor_shift` for mounts as uncertain as this one. [m]
double floor_shift_sigma(const EstimatedMount& mount);

/// The problem's Jacobian by its free parameters, blocks in their order of adding; residuals scaled as they count.
Eigen::MatrixXd dense_jacobian(ceres::Problem& problem);

}  // namespace tassilo
