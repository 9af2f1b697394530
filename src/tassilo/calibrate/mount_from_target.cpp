#include "tassilo/calibrate/mount_from_target.h"

#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/base/option_check.h"
#include "tassilo/calibrate/internal/calibration.h"
#include "tassilo/calibrate/internal/dot_image.h"
#include "tassilo/calibrate/internal/mount_values.h"
#include "tassilo/calibrate/internal/start.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

const std::string kSubject = "mount";

constexpr double kFirstSigma = 1;     ///< Of points while nothing is known of them. [px]
constexpr double kLeastSigma = 1e-4;  ///< Points are never measured better. [px]
constexpr double kHarmless = .4;      ///< A point is no outlier for less: far ones are a few pixels in size. [px]
/// Points are found to hundredths and a usable lens is known to tenths of a pixel: what is explained no better is not
/// explained. [px]
constexpr double kMostRms = 1;
/// A mount that is known so badly is worth a word: by so much it may move a place of the floor 3 m away. [m]
constexpr double kMostShift = .05;

constexpr int kPlaceCount = 4;  ///< Corrections of a place: x, y, yaw, height.
using PlaceVector = std::array<double, kPlaceCount>;

std::string mm_and_deg(double meters, double angle) {
  char out[64];
  std::snprintf(out, sizeof out, "%.0f mm and %.1f deg", 1000 * meters, degrees(angle));
  return out;
}

std::optional<PixelPoint> shown_at(const CameraModel& camera, const TargetPose& pose, const Target& target, double x,
                                   double y) {
  const auto shown = [&](double u, double v, double* pixel) {
    const Eigen::Vector3d p = pose.rotation * Eigen::Vector3d(u, v, 0) + pose.translation;
    const auto at = project(camera, {p.x(), p.y(), p.z()});
    if (!at) return false;
    pixel[0] = at->x;
    pixel[1] = at->y;
    return true;
  };
  double pixel[2];
  const bool is_shown = target.radius > 0 ? disc_centroid(x, y, target.radius, shown, pixel) : shown(x, y, pixel);
  return is_shown ? std::optional(PixelPoint{pixel[0], pixel[1]}) : std::nullopt;
}

/// All used points of one view: measured less computed, over their sigma.
struct ViewCost {
  const CameraModel& camera;
  const TargetPlace& place;
  const Target& target;
  std::vector<SeenPoint> points;
  double sigma;  ///< [px]

  bool operator()(const double* mount, const double* correction, double* residuals) const {
    const CameraMount at = mount_from(mount);
    const MountedCamera mounted(camera, at);
    const TargetPose pose = seen_by(mounted, {place.x + correction[0], place.y + correction[1],
                                              place.yaw + correction[2], place.height + correction[3]});
    for (const SeenPoint& point : points) {
      const auto computed = shown_at(camera, pose, target, point.column * target.pitch, point.row * target.pitch);
      if (!computed) return false;
      *residuals++ = (point.pixel.x - computed->x) / sigma;
      *residuals++ = (point.pixel.y - computed->y) / sigma;
    }
    return true;
  }
};

/// A correction over its sigma.
struct PlacePrior {
  PlaceVector sigma;
  template <class T>
  bool operator()(const T* correction, T* residual) const {
    for (std::size_t i = 0; i < kPlaceCount; ++i) residual[i] = correction[i] / sigma[i];
    return true;
  }
};

class MountFit {
 public:
  MountFit(const CameraModel& camera, std::span<const TargetPlace> places, std::span<const PlacedView> views,
           const MountFromTargetOptions& options)
      : camera_(camera), places_(places), views_(views), corrections_(places.size()) {
    camera_.name.clear();  // it is copied often
    prior_ = {options.place_sigma, options.place_sigma, options.place_yaw_sigma, options.place_height_sigma};
    for (const PlacedView& view : views) used_.emplace_back(view.view.points.size(), true);
  }

  void start() {
    std::optional<double> best;
    for (const PlacedView& view : views_) {
      const auto vector = start_pose(camera_, view.view);
      if (!vector) continue;
      const TargetPose pose = pose_from(*vector);
      for (const TargetPose& one : {pose, mirrored(pose, view.view.target)}) {
        mount_ = vector_from(mount_of(one, places_[view.place]));
        corrections_.assign(places_.size(), PlaceVector{});
        if (mount_[2] <= 0 || !shows_all()) continue;
        const double cost = fit(kFirstSigma, true);
        if (best && cost >= *best) continue;
        best = cost;
        best_mount_ = mount_;
        best_corrections_ = corrections_;
      }
    }
    if (!best)
      throw Error(kSubject,
                  "no camera above the floor explains what is seen; the target must lie face up at the place "
                  "that was told, and the lens must be this camera's");
    mount_ = best_mount_;
    corrections_ = best_corrections_;
  }

  void throw_out(double ratio) {
    constexpr int rounds = 3;
    for (int round = 0; round < rounds; ++round) {
      std::vector<double> off;
      for_points([&](std::size_t, std::size_t, bool used, const Eigen::Vector2d& r) {
        if (used) off.insert(off.end(), {std::abs(r.x()), std::abs(r.y())});
      });
      if (off.empty()) return;
      const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
      std::ranges::nth_element(off, middle);
      constexpr double sigma_of_median = 1.4826;  // of absolute values, for a normal distribution
      const double sigma = std::max(kLeastSigma, sigma_of_median * *middle);
      for_points([&](std::size_t v, std::size_t i, bool, const Eigen::Vector2d& r) {
        used_[v][i] = r.norm() <= std::max(kHarmless, ratio * sigma);
      });
      for (std::size_t v = 0; v < views_.size(); ++v)
        if (static_cast<std::size_t>(std::ranges::count(used_[v], true)) < kLeastPoints)
          throw Error(kSubject, "view " + std::to_string(v + 1) +
                                    " does not go with the others; its target or its place is another one");
      fit(sigma, false);
    }
  }

  /// Root mean square distance over used points, of one view or all. [px]
  double rms(std::optional<std::size_t> view = {}) const {
    double sum = 0, count = 0;
    for_points([&](std::size_t v, std::size_t, bool used, const Eigen::Vector2d& r) {
      if (!used || (view && v != *view)) return;
      sum += r.squaredNorm();
      ++count;
    });
    return count > 0 ? std::sqrt(sum / count) : 0;
  }

  /// Of one coordinate of a point, from all residuals. [px]
  double point_sigma() const {
    double sum = 0, count = 0;
    for_points([&](std::size_t, std::size_t, bool used, const Eigen::Vector2d& r) {
      if (!used) return;
      sum += r.squaredNorm();
      count += 2;
    });
    return std::max(kLeastSigma, std::sqrt(sum / std::max(1., count - 6)));
  }

  /// How much larger the variance of what neighbors have in common is than that of independent points: 1 + the
  /// correlations with the 8 neighbors, never below 1.
  double likeness() const {
    double square = 0, product = 0, points = 0;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      std::map<std::pair<int, int>, Eigen::Vector2d> at;
      for_points(
          [&](std::size_t of, std::size_t i, bool used, const Eigen::Vector2d& r) {
            const SeenPoint& p = views_[v].view.points[i];
            if (of == v && used) at[{p.column, p.row}] = r;
          },
          v);
      for (const auto& [place, r] : at) {
        square += r.squaredNorm();
        ++points;
        for (int dc = -1; dc <= 1; ++dc)
          for (int dr = -1; dr <= 1; ++dr) {
            const auto other = at.find({place.first + dc, place.second + dr});
            if ((dc != 0 || dr != 0) && other != at.end()) product += r.dot(other->second);
          }
      }
    }
    return square > 0 ? std::max(1., 1 + product / square) : 1;
  }

  /// Least squares from where it is; the cost.
  double fit(double sigma, bool robust) {
    ceres::Problem problem;
    build(problem, sigma, robust);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    options.num_threads = 1;
    constexpr int most_steps = 100;
    options.max_num_iterations = most_steps;
    options.function_tolerance = 1e-12;
    options.parameter_tolerance = 1e-11;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return summary.final_cost;
  }

  Eigen::Matrix<double, 6, 6> covariance(double sigma) {
    ceres::Problem problem;
    build(problem, sigma, false);
    const Eigen::MatrixXd jacobian = dense_jacobian(problem);
    // The mount's block was added first; places have priors, so that all is determined.
    const Eigen::MatrixXd information = jacobian.transpose() * jacobian;
    return information.ldlt()
        .solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()))
        .topLeftCorner<kMountCount, kMountCount>();
  }

  CameraMount mount() const {
    CameraMount out = mount_from(mount_.data());
    out.roll = wrap_angle(out.roll);
    out.pitch = wrap_angle(out.pitch);
    out.yaw = wrap_angle(out.yaw);
    return out;
  }
  const PlaceVector& correction(std::size_t place) const { return corrections_[place]; }

  ViewResult view_result(std::size_t v) const {
    ViewResult out;
    out.pose = pose_at(v);
    out.rms_px = rms(v);
    for_points([&](std::size_t of, std::size_t i, bool used, const Eigen::Vector2d& r) {
      if (of == v) out.points.push_back({views_[v].view.points[i].pixel, {r.x(), r.y()}, used});
    });
    return out;
  }

 private:
  /// A flat target that is seen almost as well when tilted the other way about the line of sight.
  static TargetPose mirrored(const TargetPose& pose, const Target& target) {
    const Eigen::Vector3d middle((target.columns - 1) * target.pitch / 2, (target.rows - 1) * target.pitch / 2, 0);
    const Eigen::Vector3d at = pose.rotation * middle + pose.translation, sight = at.normalized();
    const Eigen::Vector3d normal = pose.rotation.col(2);
    const Eigen::Vector3d other = 2 * normal.dot(sight) * sight - normal;
    TargetPose out;
    out.rotation = Eigen::Quaterniond::FromTwoVectors(normal, other).toRotationMatrix() * pose.rotation;
    out.translation = at - out.rotation * middle;
    return out;
  }
  static CameraMount mount_of(const TargetPose& optical_from_target, const TargetPlace& place) {
    const TargetPose lying = robot_from_target(place);
    const Eigen::Matrix3d robot_from_optical = lying.rotation * optical_from_target.rotation.transpose();
    return mount_at(robot_from_optical, lying.translation - robot_from_optical * optical_from_target.translation);
  }

  TargetPose pose_at(std::size_t v) const {
    const TargetPlace& place = places_[views_[v].place];
    const PlaceVector& c = corrections_[views_[v].place];
    return seen_by(MountedCamera(camera_, mount_from(mount_.data())),
                   {place.x + c[0], place.y + c[1], place.yaw + c[2], place.height + c[3]});
  }
  /// Calls each(view, point, used, residual) for points that have an image.
  template <class Each>
  void for_points(Each each, std::optional<std::size_t> only = {}) const {
    for (std::size_t v = 0; v < views_.size(); ++v) {
      if (only && v != *only) continue;
      const TargetView& view = views_[v].view;
      const TargetPose pose = pose_at(v);
      for (std::size_t i = 0; i < view.points.size(); ++i) {
        const SeenPoint& p = view.points[i];
        const auto at = shown_at(camera_, pose, view.target, p.column * view.target.pitch, p.row * view.target.pitch);
        constexpr double far_off = 1000;  // stands for no image [px]
        each(v, i, static_cast<bool>(used_[v][i]),
             at ? Eigen::Vector2d(p.pixel.x - at->x, p.pixel.y - at->y) : Eigen::Vector2d(far_off, far_off));
      }
    }
  }
  bool shows_all() const {
    bool all = true;
    for_points([&](std::size_t, std::size_t, bool, const Eigen::Vector2d& r) { all = all && r.norm() < 1000; });
    return all;
  }
  void build(ceres::Problem& problem, double sigma, bool robust) {
    constexpr double loss = 3;  // in sigmas of a view's middle point
    for (std::size_t v = 0; v < views_.size(); ++v) {
      const TargetView& view = views_[v].view;
      std::vector<SeenPoint> points;
      for (std::size_t i = 0; i < view.points.size(); ++i)
        if (used_[v][i]) points.push_back(view.points[i]);
      const int residuals = 2 * static_cast<int>(points.size());
      auto* cost =
          new ceres::NumericDiffCostFunction<ViewCost, ceres::CENTRAL, ceres::DYNAMIC, kMountCount, kPlaceCount>(
              new ViewCost{camera_, places_[views_[v].place], view.target, std::move(points), sigma},
              ceres::TAKE_OWNERSHIP, residuals);
      problem.AddResidualBlock(cost, robust ? new ceres::HuberLoss(loss * std::sqrt(residuals)) : nullptr,
                               mount_.data(), corrections_[views_[v].place].data());
    }
    for (PlaceVector& correction : corrections_)
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<PlacePrior, kPlaceCount, kPlaceCount>(new PlacePrior{prior_}), nullptr,
          correction.data());
  }

  CameraModel camera_;
  std::span<const TargetPlace> places_;
  std::span<const PlacedView> views_;
  PlaceVector prior_{};
  std::vector<std::vector<bool>> used_;
  MountVector mount_{}, best_mount_{};
  std::vector<PlaceVector> corrections_, best_corrections_;
};

void check_view(const PlacedView& placed, std::size_t number, std::size_t places) {
  expects(placed.place < places, "mount_from_target: a place that is there");
  const TargetView& view = placed.view;
  view.target.check();
  const std::string subject = "view " + std::to_string(number + 1);
  if (view.points.size() < kLeastPoints)
    throw Error(subject, "has " + std::to_string(view.points.size()) + " points, must be at least " +
                             std::to_string(kLeastPoints));
  if (std::ranges::all_of(view.points, [&](const SeenPoint& p) { return p.row == view.points[0].row; }) ||
      std::ranges::all_of(view.points, [&](const SeenPoint& p) { return p.column == view.points[0].column; }))
    throw Error(subject, "has its points on one line, which leaves the mount open");
}

}  // namespace

void TargetPlace::check() const {
  check_finite("place.x", x);
  check_finite("place.y", y);
  if (!(std::abs(yaw) <= 2 * std::numbers::pi))
    throw Error("place.yaw", "is " + std::to_string(yaw) + " rad, must be within one turn");
  check_finite("place.height", height);
  check_at_least("place.height", height, 0);
  constexpr double most = 20;  // [m] nobody sees a target from further
  if (std::hypot(x, y) > most)
    throw Error("place", "is " + std::to_string(std::hypot(x, y)) +
                             " m from the robot, must be at most 20; lengths are "
                             "in metres");
}

void MountFromTargetOptions::check() const {
  check_above("mount.place_sigma", place_sigma, 0);
  check_above("mount.place_yaw_sigma", place_yaw_sigma, 0);
  check_above("mount.place_height_sigma", place_height_sigma, 0);
  check_above("mount.outlier_ratio", outlier_ratio, 1);
}

TargetPose robot_from_target(const TargetPlace& place) {
  TargetPose pose;
  const double c = std::cos(place.yaw), s = std::sin(place.yaw);
  // Face up: rows go to the right of the columns' direction, z into the floor.
  pose.rotation << c, s, 0, s, -c, 0, 0, 0, -1;
  pose.translation = {place.x, place.y, place.height};
  return pose;
}

TargetPose seen_by(const MountedCamera& camera, const TargetPlace& place) {
  const TargetPose lying = robot_from_target(place);
  TargetPose seen;
  const auto turned = [&](const Eigen::Vector3d& d) {
    const OpticalPoint o = camera.optical_from_robot({d.x(), d.y(), d.z()});
    return Eigen::Vector3d(o.x, o.y, o.z);
  };
  for (int i = 0; i < 3; ++i) seen.rotation.col(i) = turned(lying.rotation.col(i));
  const RobotPoint eye = camera.center();
  seen.translation = turned(lying.translation - Eigen::Vector3d(eye.x, eye.y, eye.z));
  return seen;
}

MountFromTarget mount_from_target(const CameraModel& camera, std::span<const TargetPlace> places,
                                  std::span<const PlacedView> views, const MountFromTargetOptions& options) {
  options.check();
  camera.check();
  for (const TargetPlace& place : places) place.check();
  if (views.empty()) throw Error(kSubject, "has no view of a target, must be at least one");
  for (std::size_t v = 0; v < views.size(); ++v) check_view(views[v], v, places.size());

  MountFit fit(camera, places, views, options);
  fit.start();
  fit.throw_out(options.outlier_ratio);
  for (int round = 0; round < 2; ++round) fit.fit(fit.point_sigma(), false);

  MountFromTarget out;
  out.rms_px = fit.rms();
  if (!(out.rms_px <= kMostRms)) {
    char rms[32];
    std::snprintf(rms, sizeof rms, "%.1f px", out.rms_px);
    throw Error(kSubject, std::string("explains the target only to ") + rms +
                              "; it must lie flat on the floor at the place that was told, and the lens must be this "
                              "camera's");
  }
  out.estimate.mount = fit.mount();
  out.estimate.mount.check();
  out.estimate.covariance = fit.covariance(fit.point_sigma() * std::sqrt(fit.likeness()));
  out.estimate.sigma = sigma_of(out.estimate.covariance);
  for (std::size_t v = 0; v < views.size(); ++v) out.views.push_back(fit.view_result(v));

  for (std::size_t p = 0; p < places.size(); ++p) {
    const PlaceVector& c = fit.correction(p);
    constexpr double most = 3;  // in sigmas
    if (std::hypot(c[0], c[1]) > most * options.place_sigma || std::abs(c[2]) > most * options.place_yaw_sigma)
      out.warnings.push_back("place " + std::to_string(p + 1) + " is off by " +
                             mm_and_deg(std::hypot(c[0], c[1]), std::abs(c[2])) + " where the others put it");
  }
  if (const double shift = floor_shift_sigma(out.estimate); shift > kMostShift) {
    char text[96];
    std::snprintf(text, sizeof text, "a place of the floor 3 m away is known to %.0f cm only; ", 100 * shift);
    out.warnings.push_back(text + std::string("lay the target nearer, take a larger one, or more images"));
  }
  return out;
}

}  // namespace tassilo
