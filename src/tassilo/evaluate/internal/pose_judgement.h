#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tassilo/evaluate/internal/records.h"

namespace tassilo {

struct PoseJudgement {
  Eigen::Vector3d error;  ///< dx, dy, dtheta
  double position_m = 0, heading_deg = 0;
  bool good = false, good_mirrored = false, wrong = false;
};

/// How far a pose is from the true one; when it is marked `mirror`, from the nearer of that and its point mirror.
PoseJudgement judge_pose(const ReportedPose& pose, const TruePose& truth);

/// Normalized estimation error squared, e' C^-1 e; nothing when the row-major matrix is not positive definite.
std::optional<double> normalized_squared_error(const Eigen::VectorXd& error, const std::vector<double>& covariance);

}  // namespace tassilo
