#include "tassilo/calibrate/internal/mount_values.h"

#include <ceres/crs_matrix.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace tassilo {

CameraMount mount_from(const double* v) { return {v[0], v[1], v[2], v[3], v[4], v[5]}; }
MountVector vector_from(const CameraMount& m) { return {m.x, m.y, m.z, m.roll, m.pitch, m.yaw}; }

CameraMount mount_at(const Eigen::Matrix3d& robot_from_optical, const Eigen::Vector3d& center) {
  Eigen::Matrix3d r;  // robot_from_body: x is the optical Z, y is -X, z is -Y
  r.col(0) = robot_from_optical.col(2);
  r.col(1) = -robot_from_optical.col(0);
  r.col(2) = -robot_from_optical.col(1);
  CameraMount mount{center.x(), center.y(), center.z(), 0, 0, 0};
  mount.pitch = -std::asin(std::clamp(r(2, 0), -1., 1.));
  mount.roll = std::atan2(r(2, 1), r(2, 2));
  mount.yaw = std::atan2(r(1, 0), r(0, 0));
  return mount;
}

MountSigma sigma_of(const Eigen::Matrix<double, 6, 6>& covariance) {
  const auto root = [&](int i) { return std::sqrt(std::max(0., covariance(i, i))); };
  return {root(0), root(1), root(2), root(3), root(4), root(5)};
}

double floor_shift_sigma(const EstimatedMount& estimate) {
  // Along the principal axes of what is not known.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> axes(estimate.covariance);
  double square = 0;
  for (int i = 0; i < kMountCount; ++i) {
    const Eigen::Matrix<double, 6, 1> step =
        std::sqrt(std::max(0., axes.eigenvalues()[i])) * axes.eigenvectors().col(i);
    MountVector moved = vector_from(estimate.mount);
    for (std::size_t k = 0; k < moved.size(); ++k) moved[k] += step[static_cast<Eigen::Index>(k)];
    const double shift = floor_shift(estimate.mount, mount_from(moved.data()));
    square += shift * shift;
  }
  return std::sqrt(square);
}

Eigen::MatrixXd dense_jacobian(ceres::Problem& problem) {
  ceres::CRSMatrix sparse;
  ceres::Problem::EvaluateOptions options;
  options.num_threads = 1;
  problem.Evaluate(options, nullptr, nullptr, nullptr, &sparse);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int r = 0; r < sparse.num_rows; ++r)
    for (auto k = static_cast<std::size_t>(sparse.rows[static_cast<std::size_t>(r)]);
         k < static_cast<std::size_t>(sparse.rows[static_cast<std::size_t>(r) + 1]); ++k)
      dense(r, sparse.cols[k]) = sparse.values[k];
  return dense;
}

}  // namespace tassilo
