#include "tassilo/calibrate/mount_from_lines.h"

#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/base/option_check.h"
#include "tassilo/calibrate/internal/mount_values.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {
namespace {

const std::string kSubject = "mount";

constexpr int kTuned = 3;  ///< Height, roll, pitch.
using Tuned = std::array<double, kTuned>;
using Pose = std::array<double, 3>;  ///< x, y, theta.

constexpr std::size_t kLeastPoints = 6;  ///< Of a line: fewer have no direction.
constexpr double kLoss = 3;              ///< In sigmas of a whole line: one that lies further off draws less and less.
constexpr double kOutlier = 4;           ///< In sigmas: lines that lie so far off are others than they were taken for.
constexpr int kRounds = 5;               ///< Each with scale and weights by the last one's mount.

/// A place of a curve and its unit tangent there, on the floor of the field. [m]
struct Tangent {
  double px = 0, py = 0, tx = 0, ty = 0;
};

/// The tangent nearest to a place; of a straight line the same everywhere.
Tangent tangent_near(const FieldCurves& field, const SeenCurve& seen, FieldPoint near) {
  if (seen.is_arc) {
    const FieldArc& arc = field.arcs[seen.curve];
    const FieldPoint out = near - arc.center;
    const double away = std::max(norm(out), 1e-9), c = out.x / away, s = out.y / away;
    return {arc.center.x + arc.radius * c, arc.center.y + arc.radius * s, -s, c};
  }
  const FieldLine& line = field.lines[seen.curve];
  const FieldPoint along = (1 / distance(line.p, line.q)) * (line.q - line.p);
  const FieldPoint at = line.p + dot(near - line.p, along) * along;
  return {at.x, at.y, along.x, along.y};
}

/// A point of a seen line: its unit direction in the optical frame, where it belongs, and how many pixels an angle
/// across is there.
struct Ray {
  double x, y, z;
  Tangent tangent;
  double px_per_rad;
  PixelPoint across;  ///< Unit, in the image.
};

/// All points of one seen line. What is off is the angle between a point's ray and the plane through the eye and the
/// field's line: linear in the point's noise, unlike distances on the floor, which would pull all one way.
struct CurveCost {
  std::vector<Ray> rays;
  double camera_x, camera_y, camera_yaw;  ///< Of the mount, which stay.
  double sigma_px;
  double share;  ///< Of the mean that is taken off each: (1 - share)^2 = own^2 / (own^2 + n common^2).

  /// How far a point lies off its line. [px]
  template <class T>
  void distance_px(const T* tuned, const T* pose, const Ray& ray, T* out) const {
    using std::cos;
    using std::sin;
    using std::sqrt;
    const T bx(ray.z), by(-ray.x), bz(-ray.y);  // body frame
    // Rx, Ry, then both yaws at once.
    const T cr = cos(tuned[1]), sr = sin(tuned[1]), cp = cos(tuned[2]), sp = sin(tuned[2]);
    const T y1 = cr * by - sr * bz, z1 = sr * by + cr * bz;
    const T x2 = cp * bx + sp * z1, z2 = -sp * bx + cp * z1;
    const T turn = pose[2] + camera_yaw, c = cos(turn), s = sin(turn);
    const T dx = c * x2 - s * y1, dy = s * x2 + c * y1, dz = z2;
    // From the eye to the line; its normal is v x t.
    const T ct = cos(pose[2]), st = sin(pose[2]);
    const Tangent& t = ray.tangent;
    const T vx = t.px - pose[0] - ct * camera_x + st * camera_y, vy = t.py - pose[1] - st * camera_x - ct * camera_y;
    const T nx = tuned[0] * t.ty, ny = -tuned[0] * t.tx, nz = vx * t.ty - vy * t.tx;
    *out = (nx * dx + ny * dy + nz * dz) / sqrt(nx * nx + ny * ny + nz * nz) * ray.px_per_rad;
  }
  template <class T>
  bool operator()(T const* const* parameters, T* residuals) const {
    T mean(0.);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      distance_px(parameters[0], parameters[1], rays[i], residuals + i);
      residuals[i] += parameters[2][0];
      mean += residuals[i];
    }
    mean /= static_cast<double>(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) residuals[i] = (residuals[i] - share * mean) / sigma_px;
    return true;
  }
};

/// Numbers that should be about zero.
template <int n>
struct ZeroPrior {
  std::array<double, n> at, sigma;
  template <class T>
  bool operator()(const T* value, T* residual) const {
    for (std::size_t i = 0; i < n; ++i) residual[i] = (value[i] - at[i]) / sigma[i];
    return true;
  }
};
template <int n>
ceres::CostFunction* prior_cost(const std::array<double, n>& at, const std::array<double, n>& sigma) {
  return new ceres::AutoDiffCostFunction<ZeroPrior<n>, n, n>(new ZeroPrior<n>{at, sigma});
}

class LineFit {
 public:
  LineFit(const MountedCamera& start, const FieldCurves& field, std::span<const LineFrame> frames,
          const MountFromLinesOptions& options)
      : camera_(start.model()), mount_(start.mount()), field_(field), frames_(frames), options_(options) {
    camera_.name.clear();
    tuned_ = {mount_.z, mount_.roll, mount_.pitch};
    start_ = tuned_;
    for (const LineFrame& frame : frames) {
      poses_.push_back({frame.x, frame.y, frame.theta});
      auto& used = used_.emplace_back();
      for (const SeenCurve& seen : frame.curves) {
        expects(seen.curve < (seen.is_arc ? field.arcs.size() : field.lines.size()), "mount_from_lines: a curve");
        used.push_back(seen.points.size() >= kLeastPoints);
        shared_[key_of(seen)] = 0;
      }
    }
  }

  CameraMount mount() const {
    CameraMount out = mount_;
    out.z = tuned_[0];
    out.roll = wrap_angle(tuned_[1]);
    out.pitch = wrap_angle(tuned_[2]);
    return out;
  }

  void run() {
    for (int round = 0; round < kRounds; ++round) {
      scale();
      fit(round + 1 < kRounds);
      if (round + 2 < kRounds && round > 0) throw_out();
    }
  }

  /// Squares of whitened residuals over degrees of freedom. [1]
  double variance_factor() const {
    double sum = 0, count = -kTuned;
    for_used([&](std::size_t f, std::size_t k) {
      for (const double r : whitened(f, k)) sum += r * r, ++count;
    });
    for (std::size_t f = 0; f < frames_.size(); ++f)
      if (std::ranges::count(used_[f], true) > 0) count -= 3;
    return count > 0 ? sum / count : 1;
  }

  Eigen::Matrix3d covariance() {
    ceres::Problem problem;
    build(problem, false);
    const Eigen::MatrixXd jacobian = dense_jacobian(problem);
    const Eigen::MatrixXd information = jacobian.transpose() * jacobian;
    return information.ldlt()
        .solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()))
        .topLeftCorner<kTuned, kTuned>();
  }

  MountFromLines result() {
    MountFromLines out;
    out.estimate.mount = mount();
    double sum = 0;
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      std::size_t used = 0;
      for (std::size_t k = 0; k < frames_[f].curves.size(); ++k) {
        const bool is_used = used_[f][k];
        used += is_used;
        out.curves_thrown_out += !is_used && frames_[f].curves[k].points.size() >= kLeastPoints;
        const auto cost = cost_of(f, k);
        for (std::size_t i = 0; cost && i < cost->rays.size(); ++i) {
          double off = 0;
          cost->distance_px(tuned_.data(), poses_[f].data(), cost->rays[i], &off);
          out.residuals.push_back({frames_[f].curves[k].points[i], off * cost->rays[i].across, is_used});
          if (!is_used) continue;
          sum += off * off;
          ++out.points;
        }
      }
      out.frames += used > 0;
      out.curves += used;
    }
    out.rms_px = out.points > 0 ? std::sqrt(sum / static_cast<double>(out.points)) : 0;
    return out;
  }

 private:
  using Key = std::pair<bool, std::size_t>;
  static Key key_of(const SeenCurve& seen) { return {seen.is_arc, seen.curve}; }

  template <class Each>
  void for_used(Each each) const {
    for (std::size_t f = 0; f < frames_.size(); ++f)
      for (std::size_t k = 0; k < used_[f].size(); ++k)
        if (used_[f][k]) each(f, k);
  }

  /// A pixel's ray with where it belongs, as mount and pose are now; nothing where there is no floor.
  std::optional<Ray> ray_of(const MountedCamera& camera, std::size_t f, const SeenCurve& seen, PixelPoint pixel) const {
    const auto direction = unproject(camera_, pixel);
    const auto floor = camera.floor_point(pixel);
    if (!direction || !floor) return std::nullopt;
    const auto pose = make_pose2<FieldFrame, RobotFrame>(poses_[f][0], poses_[f][1], poses_[f][2]);
    const Tangent tangent = tangent_near(field_, seen, pose * *floor);
    const auto back = inverse(pose);
    const FloorPoint at = back * FieldPoint{tangent.px, tangent.py};
    const FloorPoint next = back * FieldPoint{tangent.px + tangent.tx, tangent.py + tangent.ty};
    const OpticalPoint a = camera.optical_from_robot(RobotPoint{at.x, at.y, 0} - camera.center()),
                       b = camera.optical_from_robot(RobotPoint{next.x, next.y, 0} - camera.center());
    const OpticalPoint normal = normalized(cross(a, b)), along = cross(normal, *direction);
    constexpr double step = 1e-4;  // [rad]
    const auto moved = project(camera_, *direction + step * normal), slid = project(camera_, *direction + step * along);
    if (!moved || !slid || !(distance(pixel, *slid) > 0)) return std::nullopt;
    const PixelPoint line = (1 / distance(pixel, *slid)) * (*slid - pixel);
    const PixelPoint move = (*moved - pixel) - dot(*moved - pixel, line) * line;
    const double px = norm(move);
    if (!(px > 0)) return std::nullopt;
    return Ray{direction->x, direction->y, direction->z, tangent, px / step, (1 / px) * move};
  }

  /// Rays and scales by the mount as it is.
  void scale() {
    const MountedCamera camera(camera_, mount());
    rays_.clear();
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      auto& of_frame = rays_.emplace_back();
      for (std::size_t k = 0; k < frames_[f].curves.size(); ++k) {
        auto& rays = of_frame.emplace_back();
        for (const PixelPoint& point : frames_[f].curves[k].points) {
          const auto ray = ray_of(camera, f, frames_[f].curves[k], point);
          if (!ray) {
            rays.clear();  // a line that reaches the horizon for this mount
            break;
          }
          rays.push_back(*ray);
        }
        if (rays.size() < kLeastPoints) used_[f][k] = false;
      }
    }
  }

  std::optional<CurveCost> cost_of(std::size_t f, std::size_t k) const {
    const SeenCurve& seen = frames_[f].curves[k];
    if (rays_[f][k].size() < kLeastPoints) return std::nullopt;
    const double own = seen.sigma_px * seen.sigma_px, common = options_.line_sigma_px * options_.line_sigma_px;
    const double share = 1 - std::sqrt(own / (own + static_cast<double>(rays_[f][k].size()) * common));
    return CurveCost{rays_[f][k], mount_.x, mount_.y, mount_.yaw, seen.sigma_px, share};
  }
  std::vector<double> whitened(std::size_t f, std::size_t k) const {
    const auto cost = cost_of(f, k);
    const double* parameters[] = {tuned_.data(), poses_[f].data(), &shared_.at(key_of(frames_[f].curves[k]))};
    std::vector<double> out(cost->rays.size());
    (*cost)(parameters, out.data());
    return out;
  }

  void throw_out() {
    for (std::size_t f = 0; f < frames_.size(); ++f)
      for (std::size_t k = 0; k < used_[f].size(); ++k) {
        if (rays_[f][k].size() < kLeastPoints) continue;
        double sum = 0;
        const auto residuals = whitened(f, k);
        for (const double r : residuals) sum += r * r;
        used_[f][k] = sum <= kOutlier * kOutlier * static_cast<double>(residuals.size());
      }
  }

  void build(ceres::Problem& problem, bool robust) {
    // So weak that they say nothing beside any line, but leave nothing open.
    problem.AddResidualBlock(prior_cost<kTuned>(start_, {.5, .5, .5}), nullptr, tuned_.data());
    for (auto& [key, shared] : shared_)
      problem.AddResidualBlock(prior_cost<1>({0}, {options_.line_sigma_px}), nullptr, &shared);
    for (std::size_t f = 0; f < frames_.size(); ++f)
      problem.AddResidualBlock(prior_cost<3>({frames_[f].x, frames_[f].y, frames_[f].theta}, {5, 5, 2}), nullptr,
                               poses_[f].data());
    for_used([&](std::size_t f, std::size_t k) {
      auto cost = cost_of(f, k);
      if (!cost) return;
      const auto count = static_cast<int>(cost->rays.size());
      auto* function = new ceres::DynamicAutoDiffCostFunction<CurveCost, 7>(new CurveCost(std::move(*cost)));
      function->AddParameterBlock(kTuned);
      function->AddParameterBlock(3);
      function->AddParameterBlock(1);
      function->SetNumResiduals(count);
      problem.AddResidualBlock(function, robust ? new ceres::CauchyLoss(kLoss * std::sqrt(count)) : nullptr,
                               tuned_.data(), poses_[f].data(), &shared_.at(key_of(frames_[f].curves[k])));
    });
  }

  void fit(bool robust) {
    ceres::Problem problem;
    build(problem, robust);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    options.logging_type = ceres::SILENT;
    options.num_threads = 1;
    constexpr int most_steps = 50;
    options.max_num_iterations = most_steps;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
  }

  CameraModel camera_;
  CameraMount mount_;
  const FieldCurves& field_;
  std::span<const LineFrame> frames_;
  MountFromLinesOptions options_;
  Tuned tuned_{}, start_{};
  std::vector<Pose> poses_;
  std::map<Key, double> shared_;  ///< By curve: what its points are off in all frames. [px]
  std::vector<std::vector<bool>> used_;
  std::vector<std::vector<std::vector<Ray>>> rays_;
};

std::string text_of(const char* name, double value, const char* unit, int digits) {
  char out[64];
  std::snprintf(out, sizeof out, "%s to %.*f %s", name, digits, value, unit);
  return out;
}

}  // namespace

void MountFromLinesOptions::check() const {
  check_above("mount.line_sigma_px", line_sigma_px, 0);
  check_above("mount.most_height_sigma", most_height_sigma, 0);
  check_above("mount.most_angle_sigma", most_angle_sigma, 0);
}

MountFromLines mount_from_lines(const MountedCamera& start, const FieldCurves& field, std::span<const LineFrame> frames,
                                const MountFromLinesOptions& options) {
  options.check();
  start.model().check();
  start.mount().check();
  LineFit fit(start, field, frames, options);
  fit.run();
  MountFromLines out = fit.result();
  if (out.points == 0) throw Error(kSubject, "no line of the field is seen, must be some that cross");
  const Eigen::Matrix3d covariance = std::max(1., fit.variance_factor()) * fit.covariance();
  constexpr std::array<int, kTuned> at{2, 3, 4};  // z, roll, pitch
  for (int i = 0; i < kTuned; ++i)
    for (int k = 0; k < kTuned; ++k)
      out.estimate.covariance(at[static_cast<std::size_t>(i)], at[static_cast<std::size_t>(k)]) = covariance(i, k);
  out.estimate.sigma = sigma_of(out.estimate.covariance);

  std::string open;
  const auto judge = [&](bool is_open, const std::string& text) {
    if (is_open) open += (open.empty() ? "" : ", ") + text;
  };
  const MountSigma& sigma = out.estimate.sigma;
  judge(!(sigma.z <= options.most_height_sigma), text_of("height", 100 * sigma.z, "cm", 0));
  judge(!(sigma.roll <= options.most_angle_sigma), text_of("roll", degrees(sigma.roll), "deg", 1));
  judge(!(sigma.pitch <= options.most_angle_sigma), text_of("pitch", degrees(sigma.pitch), "deg", 1));
  if (!open.empty())
    throw Error(kSubject, "the lines that are seen do not determine it (" + open +
                              "); take frames that show lines of several directions, near and far");
  out.estimate.mount.check();
  return out;
}

}  // namespace tassilo
