#include "tassilo/calibrate/internal/plane_map.h"

#include <Eigen/Dense>
#include <cmath>

#include "tassilo/base/contract.h"

namespace tassilo {
namespace {

/// Moves the points' mean to the origin and their mean distance to sqrt 2.
Eigen::Matrix3d normalizing(std::span<const Eigen::Vector2d> points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  double spread = 0;
  for (const auto& p : points) spread += (p - mean).norm();
  const double scale = spread > 0 ? std::sqrt(2.) * static_cast<double>(points.size()) / spread : 1;
  Eigen::Matrix3d map;
  map << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
  return map;
}

}  // namespace

std::optional<Eigen::Matrix3d> plane_map(std::span<const Eigen::Vector2d> from, std::span<const Eigen::Vector2d> to) {
  expects(from.size() == to.size(), "plane_map: pairs of points");
  if (from.size() < 4) return std::nullopt;
  const Eigen::Matrix3d left = normalizing(from), right = normalizing(to);
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector3d p = left * from[i].homogeneous(), q = right * to[i].homogeneous();
    Eigen::Matrix<double, 2, 9> rows;
    rows << p.transpose(), Eigen::RowVector3d::Zero(), -q.x() * p.transpose(),  //
        Eigen::RowVector3d::Zero(), p.transpose(), -q.y() * p.transpose();
    normal += rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(normal);
  if (!(solver.eigenvalues()(1) > 1e-12 * solver.eigenvalues()(8))) return std::nullopt;
  const Eigen::Matrix<double, 9, 1> h = solver.eigenvectors().col(0);
  Eigen::Matrix3d map;
  map << h.segment<3>(0).transpose(), h.segment<3>(3).transpose(), h.segment<3>(6).transpose();
  map = right.inverse() * map * left;
  if (!map.allFinite() || map.norm() == 0) return std::nullopt;
  return map / map.norm();
}

}  // namespace tassilo
