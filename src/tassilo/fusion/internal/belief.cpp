#include "tassilo/fusion/internal/belief.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tassilo/base/contract.h"

namespace tassilo {
namespace {

int offset_of(int witness) { return 4 + 3 * witness; }

using Gain = Eigen::Matrix<double, Eigen::Dynamic, 2, 0, kMaxBeliefSize, 2>;

/// Covariance of all numbers with the place as this witness sees it.
Gain with_place(const Belief& belief, const Evidence& evidence, int witness) {
  Gain columns = belief.covariance.leftCols<2>();
  if (witness >= 0) columns += belief.covariance.middleCols<3>(offset_of(witness)) * evidence.by_error.transpose();
  return columns;
}

/// Of what is seen, given what is believed; positive definite as the noise is.
Eigen::Matrix2d spread_of(const Gain& columns, const Evidence& evidence, int witness) {
  Eigen::Matrix2d spread = columns.topRows<2>() + evidence.noise;
  if (witness >= 0)
    spread += evidence.by_error * columns.middleRows<3>(offset_of(witness));
  else
    spread += evidence.by_error * evidence.by_error.transpose();
  return (spread + spread.transpose()) / 2;
}

Eigen::Vector2d surprise(const Belief& belief, const Evidence& evidence, int witness) {
  Eigen::Vector2d off = evidence.place - belief.mean.head<2>();
  if (witness >= 0) off -= evidence.by_error * belief.mean.segment<3>(offset_of(witness));
  return off;
}

}  // namespace

Belief begun(const Evidence& evidence, double speed_sigma) {
  Belief belief;
  belief.mean.setZero(4);
  belief.mean.head<2>() = evidence.place;
  belief.covariance.setZero(4, 4);
  belief.covariance.diagonal().tail<2>().setConstant(speed_sigma * speed_sigma);
  // The place comes from the sighting, as an observation of a thing that may be anywhere would have it.
  add_witness(belief);
  Eigen::Matrix2d all = evidence.noise + evidence.by_error * evidence.by_error.transpose();
  belief.covariance.topLeftCorner<2, 2>() = (all + all.transpose()) / 2;
  belief.covariance.block<2, 3>(0, 4) = -evidence.by_error;
  belief.covariance.block<3, 2>(4, 0) = -evidence.by_error.transpose();
  return belief;
}

void roll(Belief& belief, double dt, const Rolling& rolling) {
  if (!(dt > 0)) return;
  auto& mean = belief.mean;
  auto& covariance = belief.covariance;
  // The mean of v/|v| is nearly v / sqrt(v^2 + its variance): exact for one that is known, 0 for one that is not.
  const double speed = std::sqrt(mean.segment<2>(2).squaredNorm() + std::max(covariance(2, 2) + covariance(3, 3), 0.));
  const double left = speed > 0 ? std::max(1 - rolling.friction * dt / speed, 0.) : 1;
  const double reach = dt * (1 + left) / 2;
  mean.head<2>() += reach * mean.segment<2>(2);
  mean.segment<2>(2) *= left;
  covariance.topRows<2>() += reach * covariance.middleRows<2>(2);
  covariance.middleRows<2>(2) *= left;
  covariance.leftCols<2>() += reach * covariance.middleCols<2>(2);
  covariance.middleCols<2>(2) *= left;
  for (int axis = 0; axis < 2; ++axis) {
    covariance(axis, axis) += rolling.walk * dt * dt * dt / 3;
    covariance(axis, axis + 2) += rolling.walk * dt * dt / 2;
    covariance(axis + 2, axis) += rolling.walk * dt * dt / 2;
    covariance(axis + 2, axis + 2) += rolling.walk * dt;
  }
  const auto errors = mean.size() - 4;
  if (errors == 0) return;
  const double kept = std::exp(-dt / rolling.error_memory);
  mean.tail(errors) *= kept;
  covariance.bottomRows(errors) *= kept;
  covariance.rightCols(errors) *= kept;
  covariance.diagonal().tail(errors).array() += 1 - kept * kept;
}

void add_witness(Belief& belief) {
  const auto size = belief.mean.size();
  expects(size + 3 <= kMaxBeliefSize, "add_witness: room for one more");
  belief.mean.conservativeResize(size + 3);
  belief.mean.tail<3>().setZero();
  belief.covariance.conservativeResize(size + 3, size + 3);
  belief.covariance.rightCols<3>().setZero();
  belief.covariance.bottomRows<3>().setZero();
  belief.covariance.bottomRightCorner<3, 3>().setIdentity();
}

void remove_witness(Belief& belief, int witness) {
  const auto size = belief.mean.size();
  const int here = offset_of(witness);
  expects(witness >= 0 && here + 3 <= size, "remove_witness: one that there is");
  if (here + 3 < size) {
    belief.mean.segment<3>(here) = belief.mean.tail<3>().eval();
    belief.covariance.middleRows<3>(here) = belief.covariance.bottomRows<3>().eval();
    belief.covariance.middleCols<3>(here) = belief.covariance.rightCols<3>().eval();
  }
  belief.mean.conservativeResize(size - 3);
  belief.covariance.conservativeResize(size - 3, size - 3);
}

int witness_count(const Belief& belief) { return static_cast<int>(belief.mean.size() - 4) / 3; }

Fit fit(const Belief& belief, const Evidence& evidence, int witness) {
  const Eigen::Matrix2d spread = spread_of(with_place(belief, evidence, witness), evidence, witness);
  const Eigen::Vector2d off = surprise(belief, evidence, witness);
  const double squared = off.dot(spread.inverse() * off);
  return {squared, squared + 2 * std::log(2 * std::numbers::pi) + std::log(spread.determinant())};
}

void observe(Belief& belief, const Evidence& evidence, int witness) {
  expects(witness >= 0, "observe: of a witness that the belief knows");
  const Gain columns = with_place(belief, evidence, witness);
  const Gain gain = columns * spread_of(columns, evidence, witness).inverse();
  belief.mean += gain * surprise(belief, evidence, witness);
  auto& covariance = belief.covariance;
  covariance.noalias() -= gain * columns.transpose();
  const Gain left = with_place(belief, evidence, witness);
  covariance.noalias() -= left * gain.transpose();
  covariance.noalias() += (gain * evidence.noise).eval() * gain.transpose();
  covariance = (covariance + covariance.transpose()).eval() / 2;
}

Belief mixed(const Belief& a, const Belief& b, double share) {
  Belief all;
  const auto apart = (b.mean - a.mean).eval();
  all.mean = a.mean + share * apart;
  all.covariance = (1 - share) * a.covariance + share * b.covariance + share * (1 - share) * apart * apart.transpose();
  return all;
}

}  // namespace tassilo
