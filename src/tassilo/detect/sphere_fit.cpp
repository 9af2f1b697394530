#include "tassilo/detect/sphere_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tassilo/base/contract.h"

namespace tassilo {
namespace {

/// Distance of a ray from the outline, and its derivative by (x, y, radius). [px]
struct Residual {
  double value = 0;
  Eigen::Vector3d by_state = Eigen::Vector3d::Zero();
};

Eigen::Vector3d eigen(RobotPoint p) { return {p.x, p.y, p.z}; }

/// Unit vector across a direction, level: to the right as seen along it. Any level one where the direction is vertical.
RobotPoint level_right(RobotPoint direction) {
  const RobotPoint right = cross(direction, RobotPoint{0, 0, 1});
  return norm(right) > 0 ? normalized(right) : RobotPoint{0, -1, 0};
}

/// Pixels per radian around a direction: the geometric mean of both axes of the image. [px/rad]
double pixels_per_radian(const MountedCamera& camera, RobotPoint direction) {
  const RobotPoint unit = normalized(direction);
  const RobotPoint side = -1 * level_right(unit);
  const RobotPoint up = cross(unit, side);
  constexpr double step = 1e-3;
  const auto center = camera.project(camera.center() + unit);
  const auto beside = camera.project(camera.center() + unit + step * side);
  const auto above = camera.project(camera.center() + unit + step * up);
  if (!center || !beside || !above) return std::sqrt(camera.model().fx * camera.model().fy);
  const double stretch = std::abs(cross(*beside - *center, *above - *center));
  return std::sqrt(std::max(stretch, 1e-12)) / step;
}

}  // namespace

RecycledVector<OutlinePoint> outline(const MountedCamera& camera, const RestingSphere& sphere, int count) {
  RecycledVector<OutlinePoint> points;
  const RobotPoint sight = sphere.center() - camera.center();
  const double range = norm(sight);
  if (range <= sphere.radius) return points;
  const RobotPoint axis = (1 / range) * sight;
  const RobotPoint right = level_right(axis);
  const RobotPoint up = cross(right, axis);
  const double sine = sphere.radius / range, cosine = std::sqrt(1 - sine * sine);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    const RobotPoint radial = std::cos(angle) * right + std::sin(angle) * up;
    const auto on = camera.project(camera.center() + cosine * axis + sine * radial);
    const auto out = camera.project(camera.center() + cosine * axis + (1.05 * sine) * radial);
    if (!on || !out) continue;
    const double length = distance(*out, *on);
    if (length > 0) points.push_back({*on, (1 / length) * (*out - *on)});
  }
  return points;
}

std::optional<ProjectedDisc> project_disc(const MountedCamera& camera, const RestingSphere& sphere) {
  const auto center = camera.project(sphere.center());
  const auto around = outline(camera, sphere, 16);
  if (!center || around.size() < 16) return std::nullopt;
  double sum = 0;
  for (const OutlinePoint& p : around) sum += distance(p.at, *center);
  return ProjectedDisc{*center, sum / static_cast<double>(around.size())};
}

std::optional<SphereFit> fit_resting_sphere(const MountedCamera& camera, std::span<const PixelPoint> edges,
                                            const RestingSphere& start, const SphereFitOptions& options) {
  expects(edges.size() >= 3, "three edges or more");
  RecycledVector<Eigen::Vector3d> rays;
  for (const PixelPoint& edge : edges)
    if (const auto ray = camera.ray(edge)) rays.push_back(eigen(*ray));
  if (rays.size() < 3) return std::nullopt;

  const Eigen::Vector3d eye = eigen(camera.center());
  const double px_per_rad = pixels_per_radian(camera, start.center() - camera.center());
  const double radius_sigma = std::max(1e-4, (options.radius.high - options.radius.low) / std::sqrt(12.0));
  Eigen::Vector3d state(start.foot.x, start.foot.y, options.radius.middle());

  const auto residuals = [&](const Eigen::Vector3d& s, RecycledVector<Residual>& out) {
    const Eigen::Vector3d sight = Eigen::Vector3d(s[0], s[1], s[2]) - eye;
    const double range = sight.norm();
    if (!(range > 1.05 * s[2])) return false;
    const double sine = s[2] / range, width = std::sqrt(1 - sine * sine), radius_angle = std::asin(sine);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double cosine = std::clamp(rays[i].dot(sight) / range, -1.0, 1.0);
      const double across = std::sqrt(std::max(1e-12, 1 - cosine * cosine));
      out[i].value = px_per_rad * (std::acos(cosine) - radius_angle);
      const Eigen::Vector3d by_center =
          -(rays[i] - cosine * sight / range) / (range * across) + (sine / (width * range)) * (sight / range);
      // The centre rises with the radius.
      out[i].by_state = px_per_rad * Eigen::Vector3d(by_center[0], by_center[1], by_center[2] - 1 / (width * range));
    }
    return true;
  };

  RecycledVector<Residual> r(rays.size());
  const double sigma = options.edge_sigma_px, huber = 2 * sigma;
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    if (!residuals(state, r)) return std::nullopt;
    information.setZero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (const auto& [value, by_state] : r) {
      const double weight = (std::abs(value) <= huber ? 1 : huber / std::abs(value)) / (sigma * sigma);
      information += weight * by_state * by_state.transpose();
      gradient += weight * value * by_state;
    }
    information(2, 2) += 1 / (radius_sigma * radius_sigma);
    gradient[2] += (state[2] - options.radius.middle()) / (radius_sigma * radius_sigma);
    Eigen::Vector3d step = -information.ldlt().solve(gradient);
    if (!step.allFinite()) return std::nullopt;
    // A step longer than half the distance leaves the region where the outline is nearly linear.
    const double range = std::hypot(state[0] - eye[0], state[1] - eye[1]);
    const double length = std::hypot(step[0], step[1]);
    if (length > 0.5 * range) step *= 0.5 * range / length;
    state += step;
    state[2] = std::clamp(state[2], options.radius.low, options.radius.high);
    if (length < 1e-4) break;  // a tenth of a millimeter
  }
  if (!residuals(state, r)) return std::nullopt;
  SphereFit fit;
  fit.sphere = {{state[0], state[1]}, state[2]};
  fit.covariance = information.inverse();
  double squares = 0;
  std::ptrdiff_t inliers = 0;
  for (const Residual& residual : r) {
    squares += residual.value * residual.value;
    inliers += std::abs(residual.value) <= 3 * sigma;
  }
  fit.rms_px = std::sqrt(squares / static_cast<double>(r.size()));
  fit.inlier_share = static_cast<double>(inliers) / static_cast<double>(r.size());
  if (!camera.project(fit.sphere.center())) return std::nullopt;  // behind the camera
  // Edges that leave a direction open have no covariance, but for rounding.
  if (!fit.covariance.allFinite() || !(fit.covariance.diagonal().array() > 0).all()) return std::nullopt;
  return fit;
}

}  // namespace tassilo
