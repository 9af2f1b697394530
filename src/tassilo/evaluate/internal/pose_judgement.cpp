#include "tassilo/evaluate/internal/pose_judgement.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

constexpr double kGoodPosition = 0.10, kGoodHeadingDeg = 3, kWrongPosition = 0.5, kWrongHeadingDeg = 15;

struct Offset {
  Eigen::Vector3d error;
  double position, heading_deg;

  bool within(double metres, double deg) const { return position <= metres && heading_deg <= deg; }
};

/// From the true pose turned by `turn` about the field's centre, with `sign` = cos(turn).
Offset offset(const ReportedPose& pose, const TruePose& truth, double sign, double turn) {
  const Eigen::Vector3d e(pose.x - sign * truth.x, pose.y - sign * truth.y,
                          wrap_angle(pose.theta - truth.theta - turn));
  return {e, std::hypot(e.x(), e.y()), degrees(std::abs(e.z()))};
}

}  // namespace

PoseJudgement judge_pose(const ReportedPose& pose, const TruePose& truth) {
  const Offset straight = offset(pose, truth, 1, 0), mirrored = offset(pose, truth, -1, std::numbers::pi);
  const auto wrong = [](const Offset& o) { return !o.within(kWrongPosition, kWrongHeadingDeg); };
  const bool takes_mirror =
      pose.mirror && (wrong(mirrored) != wrong(straight) ? wrong(straight) : mirrored.position < straight.position);
  const Offset& judged = takes_mirror ? mirrored : straight;
  const bool good = straight.within(kGoodPosition, kGoodHeadingDeg);
  return {
      judged.error, judged.position, judged.heading_deg, good, good || mirrored.within(kGoodPosition, kGoodHeadingDeg),
      wrong(judged)};
}

std::optional<double> normalized_squared_error(const Eigen::VectorXd& error, const std::vector<double>& covariance) {
  const Eigen::Map<const Eigen::MatrixXd> raw(covariance.data(), error.size(), error.size());
  const Eigen::MatrixXd c = (raw + raw.transpose()) / 2;
  if (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(c, Eigen::EigenvaluesOnly).eigenvalues()(0) <= 0)
    return std::nullopt;
  return error.dot(c.partialPivLu().solve(error));
}

}  // namespace tassilo
