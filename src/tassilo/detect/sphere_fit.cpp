#include "tassilo/detect/sphere_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tassilo/base/contract.h"

namespace tassilo {
namespace {

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

/// Where the cone of rays that touch a sphere lies, with directions across it.
struct Cone {
  RobotPoint axis, right, up;   ///< Unit.
  double sine = 0, cosine = 1;  ///< Of half its opening.

  /// Direction `scale` times as far off the axis as the cone; c, s: cosine and sine of the angle from `right` to `up`.
  RobotPoint at(double c, double s, double scale = 1) const {
    return cosine * axis + (scale * sine * c) * right + (scale * sine * s) * up;
  }
};
std::optional<Cone> cone_of(const MountedCamera& camera, const RestingSphere& sphere) {
  const RobotPoint sight = sphere.center() - camera.center();
  const double range = norm(sight);
  if (range <= sphere.radius) return std::nullopt;
  Cone cone;
  cone.axis = (1 / range) * sight;
  cone.right = level_right(cone.axis);
  cone.up = cross(cone.right, cone.axis);
  cone.sine = sphere.radius / range;
  cone.cosine = std::sqrt(1 - cone.sine * cone.sine);
  return cone;
}

std::optional<OutlinePoint> with_outward(PixelPoint at, PixelPoint outward) {
  const double length = std::sqrt(dot(outward, outward));
  if (!(length > 0)) return std::nullopt;
  return OutlinePoint{at, (1 / length) * outward};
}

/// The angle whose sine is x, for small x as fast as a product: the series up to x^9, off by 4e-8 at most.
double small_arc_sine(double x) {
  const double q = x * x;
  if (q > 0.09) return std::asin(x);
  return x * (1 + q * (1. / 6 + q * (3. / 40 + q * (5. / 112 + q * (35. / 1152)))));
}

/// Weighted squares of the edges' distances from an outline, and how they change with (x, y, radius).
struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double squares = 0;  ///< Unweighted. [px^2]
  int inliers = 0;     ///< Within three sigma.
};

/// Nothing when the eye is inside the sphere, or nearly.
std::optional<NormalEquations> residuals(std::span<const RobotPoint> rays, RobotPoint sight, double radius,
                                         double px_per_rad, double sigma) {
  const double range = norm(sight);
  if (!(range > 1.05 * radius)) return std::nullopt;
  const RobotPoint axis = (1 / range) * sight;
  const double sine = radius / range, width = std::sqrt(1 - sine * sine), huber = 2 * sigma;
  const double along = sine / (width * range), rise = 1 / (width * range);
  NormalEquations out;
  double xx = 0, xy = 0, xr = 0, yy = 0, yr = 0, rr = 0, x = 0, y = 0, r = 0;
  for (const RobotPoint& ray : rays) {
    const double cosine = std::clamp(dot(ray, axis), -1.0, 1.0);
    const double across = std::sqrt(std::max(1e-12, 1 - cosine * cosine));
    // The angle between ray and axis less the cone's half opening; behind the eye only the long way is right.
    const double off =
        cosine > 0 ? small_arc_sine(across * width - cosine * sine) : std::acos(cosine) - std::asin(sine);
    const double value = px_per_rad * off;
    const double outward = -px_per_rad / (range * across), inward = px_per_rad * along - outward * cosine;
    // The centre rises with the radius.
    const double by_x = outward * ray.x + inward * axis.x, by_y = outward * ray.y + inward * axis.y;
    const double by_r = outward * ray.z + inward * axis.z - px_per_rad * rise;
    const double size = std::abs(value), weight = (size <= huber ? 1 : huber / size) / (sigma * sigma);
    xx += weight * by_x * by_x;
    xy += weight * by_x * by_y;
    xr += weight * by_x * by_r;
    yy += weight * by_y * by_y;
    yr += weight * by_y * by_r;
    rr += weight * by_r * by_r;
    x += weight * value * by_x;
    y += weight * value * by_y;
    r += weight * value * by_r;
    out.squares += value * value;
    out.inliers += size <= 3 * sigma;
  }
  out.information << xx, xy, xr, xy, yy, yr, xr, yr, rr;
  out.gradient << x, y, r;
  return out;
}

}  // namespace

RecycledVector<OutlinePoint> outline(const MountedCamera& camera, const RestingSphere& sphere, int count) {
  RecycledVector<OutlinePoint> points;
  const auto cone = cone_of(camera, sphere);
  if (!cone) return points;
  const auto center = camera.project(sphere.center());
  if (!center) return points;
  points.reserve(static_cast<std::size_t>(count));
  const double turn_cosine = std::cos(2 * std::numbers::pi / count), turn_sine = std::sin(2 * std::numbers::pi / count);
  double c = 1, s = 0;
  for (int i = 0; i < count; ++i) {
    if (const auto place = camera.project(camera.center() + cone->at(c, s)))
      if (const auto point = with_outward(*place, *place - *center)) points.push_back(*point);
    const double before = c;
    c = turn_cosine * before - turn_sine * s;
    s = turn_cosine * s + turn_sine * before;
  }
  return points;
}

std::optional<OutlinePoint> lowest_of_outline(const MountedCamera& camera, const RestingSphere& sphere) {
  const auto cone = cone_of(camera, sphere);
  if (!cone) return std::nullopt;
  const auto on = camera.project(camera.center() + cone->at(0, -1));
  const auto beyond = camera.project(camera.center() + cone->at(0, -1, 1.05));
  return on && beyond ? with_outward(*on, *beyond - *on) : std::nullopt;
}

std::optional<ProjectedDisc> disc_of(const MountedCamera& camera, const RestingSphere& sphere,
                                     std::span<const OutlinePoint> outline, int count) {
  const auto center = camera.project(sphere.center());
  if (!center || outline.size() < static_cast<std::size_t>(count)) return std::nullopt;
  double sum = 0;
  for (const OutlinePoint& p : outline) sum += distance(p.at, *center);
  return ProjectedDisc{*center, sum / static_cast<double>(outline.size())};
}

std::optional<ProjectedDisc> project_disc(const MountedCamera& camera, const RestingSphere& sphere) {
  constexpr int count = 16;
  return disc_of(camera, sphere, outline(camera, sphere, count), count);
}

std::optional<SphereFit> fit_resting_sphere(const MountedCamera& camera, std::span<const PixelPoint> edges,
                                            const RestingSphere& start, const SphereFitOptions& options) {
  expects(edges.size() >= 3, "three edges or more");
  RecycledVector<RobotPoint> rays;
  rays.reserve(edges.size());
  for (const PixelPoint& edge : edges)
    if (const auto ray = camera.ray(edge)) rays.push_back(*ray);
  if (rays.size() < 3) return std::nullopt;
  return fit_resting_sphere(camera, std::span<const RobotPoint>(rays), start, options);
}

std::optional<SphereFit> fit_resting_sphere(const MountedCamera& camera, std::span<const RobotPoint> rays,
                                            const RestingSphere& start, const SphereFitOptions& options) {
  expects(rays.size() >= 3, "three rays or more");
  const RobotPoint eye = camera.center();
  const double px_per_rad = pixels_per_radian(camera, start.center() - eye);
  const double radius_sigma = std::max(1e-4, (options.radius.high - options.radius.low) / std::sqrt(12.0));
  Eigen::Vector3d state(start.foot.x, start.foot.y, options.radius.middle());
  const auto here = [&] {
    return residuals(rays, RobotPoint{state[0], state[1], state[2]} - eye, state[2], px_per_rad, options.edge_sigma_px);
  };
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    auto equations = here();
    if (!equations) return std::nullopt;
    equations->information(2, 2) += 1 / (radius_sigma * radius_sigma);
    equations->gradient[2] += (state[2] - options.radius.middle()) / (radius_sigma * radius_sigma);
    information = equations->information;
    Eigen::Vector3d step = -information.ldlt().solve(equations->gradient);
    if (!step.allFinite()) return std::nullopt;
    // A step longer than half the distance leaves the region where the outline is nearly linear.
    const double range = std::hypot(state[0] - eye.x, state[1] - eye.y);
    if (range > options.furthest) return std::nullopt;
    const double length = std::hypot(step[0], step[1]);
    if (length > 0.5 * range) step *= 0.5 * range / length;
    state += step;
    state[2] = std::clamp(state[2], options.radius.low, options.radius.high);
    if (length < 1e-4) break;  // a tenth of a millimeter
  }
  const auto last = here();
  if (!last) return std::nullopt;
  SphereFit fit;
  fit.sphere = {{state[0], state[1]}, state[2]};
  fit.covariance = information.inverse();
  fit.rms_px = std::sqrt(last->squares / static_cast<double>(rays.size()));
  fit.inlier_share = static_cast<double>(last->inliers) / static_cast<double>(rays.size());
  if (!camera.project(fit.sphere.center())) return std::nullopt;  // behind the camera
  // Edges that leave a direction open have no covariance, but for rounding.
  if (!fit.covariance.allFinite() || !(fit.covariance.diagonal().array() > 0).all()) return std::nullopt;
  return fit;
}

}  // namespace tassilo
