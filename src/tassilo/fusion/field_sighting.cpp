#include "tassilo/fusion/field_sighting.h"

#include <algorithm>
#include <cmath>

#include "tassilo/geometry/pose2.h"

namespace tassilo {

FieldSighting on_field(const PoseSeen& pose, const Gaussian2<RobotFrame>& seen) {
  const FieldFromRobot field_from_robot = make_pose2<FieldFrame, RobotFrame>(pose.x, pose.y, pose.theta);
  const double c = field_from_robot.cos, s = field_from_robot.sin;
  FieldSighting sighting;
  sighting.place = field_from_robot * seen.mean;
  Eigen::Matrix2d turn;
  turn << c, -s, s, c;
  const Eigen::Matrix2d own = turn * seen.covariance * turn.transpose();
  sighting.own = (own + own.transpose()) / 2;
  sighting.by_pose << 1, 0, -(sighting.place.y - pose.y), 0, 1, sighting.place.x - pose.x;
  return sighting;
}

Gaussian2<FieldFrame> gaussian(const FieldSighting& sighting, const PoseSeen& pose) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> covariance(pose.covariance.data());
  const Eigen::Matrix2d all = sighting.own + sighting.by_pose * covariance * sighting.by_pose.transpose();
  return {sighting.place, (all + all.transpose()) / 2};
}

Eigen::Matrix3d square_root(const Eigen::Matrix3d& covariance) {
  // Cholesky's method; a column without variance of its own stays zero. Eigenvectors would do for one matrix, but those
  // of the next, nearly equal one may come in another order.
  Eigen::Matrix3d root = Eigen::Matrix3d::Zero();
  for (int j = 0; j < 3; ++j) {
    const double left = covariance(j, j) - root.row(j).squaredNorm();
    if (!(left > 1e-12 * covariance(j, j)) || !(left > 1e-300)) continue;
    root(j, j) = std::sqrt(left);
    for (int i = j + 1; i < 3; ++i) {
      const double value = (covariance(i, j) - root.row(i).dot(root.row(j))) / root(j, j);
      // No more correlated than to 1: what is left of row i's variance bounds it.
      const double most = std::sqrt(std::max(covariance(i, i) - root.row(i).squaredNorm(), 0.));
      root(i, j) = std::clamp(value, -most, most);
    }
  }
  return root;
}

}  // namespace tassilo
