#include "tassilo/calibrate/internal/bundle.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Dense>
#include <cmath>

#include "tassilo/calibrate/internal/dot_image.h"
#include "tassilo/calibrate/internal/lens.h"

namespace tassilo {
namespace {

constexpr int kMostSteps = 100;

/// One point of a target: measured less computed.
template <class Lens>
struct PointCost {
  Eigen::Vector2d on_target, seen;
  double radius;  ///< Of a dot, 0 of a corner. [m]

  template <class T>
  bool shown(const T* camera, const T* pose, double x, double y, T* pixel) const {
    const T target[3] = {T(x), T(y), T(0)};
    T optical[3];
    ceres::AngleAxisRotatePoint(pose, target, optical);
    for (int i = 0; i < 3; ++i) optical[i] += pose[3 + i];
    T distorted[2];
    if (!Lens::distort(camera + kPinholeCount, optical, distorted)) return false;
    pixel[0] = camera[0] * distorted[0] + camera[2];
    pixel[1] = camera[1] * distorted[1] + camera[3];
    return true;
  }

  template <class T>
  bool operator()(const T* camera, const T* pose, T* residual) const {
    T pixel[2];
    const auto shows = [&](double x, double y, T* at) { return shown(camera, pose, x, y, at); };
    const bool is_seen = radius > 0 ? disc_centroid(on_target.x(), on_target.y(), radius, shows, pixel)
                                    : shows(on_target.x(), on_target.y(), pixel);
    if (!is_seen) return false;
    residual[0] = seen.x() - pixel[0];
    residual[1] = seen.y() - pixel[1];
    return true;
  }
};

std::unique_ptr<ceres::CostFunction> cost_of(LensModel model, const Target& target, const SeenPoint& point) {
  return with_lens(model, [&](auto lens) -> std::unique_ptr<ceres::CostFunction> {
    using Lens = decltype(lens);
    using Cost = PointCost<Lens>;
    return std::make_unique<ceres::AutoDiffCostFunction<Cost, 2, kPinholeCount + Lens::kCoefficients, 6>>(new Cost{
        {point.column * target.pitch, point.row * target.pitch}, {point.pixel.x, point.pixel.y}, target.radius});
  });
}

}  // namespace

TargetPose pose_from(const PoseVector& pose) {
  TargetPose out;
  ceres::AngleAxisToRotationMatrix(pose.data(), out.rotation.data());
  out.translation = {pose[3], pose[4], pose[5]};
  return out;
}

struct Bundle::Costs {
  std::vector<std::vector<std::unique_ptr<ceres::CostFunction>>> of;  ///< By view and point.
};

Bundle::Bundle(LensModel model, std::span<const TargetView> views)
    : model_(model), views_(views), view_used_(views.size(), true), costs_(std::make_unique<Costs>()) {
  for (const TargetView& view : views) {
    point_used_.emplace_back(view.points.size(), true);
    auto& costs = costs_->of.emplace_back();
    for (const SeenPoint& point : view.points) costs.push_back(cost_of(model, view.target, point));
  }
}

Bundle::~Bundle() = default;

std::size_t Bundle::used_points(std::size_t view) const {
  std::size_t count = 0;
  for (std::size_t point = 0; point < point_used_[view].size(); ++point) count += uses(view, point);
  return count;
}

BundleFit Bundle::fit(BundleState start, std::span<const int> fixed, const Sigmas& sigmas, double loss) const {
  const std::vector<int> stays(fixed.begin(), fixed.end());
  return solve(std::move(start), &stays, sigmas, loss);
}

BundleFit Bundle::fit_poses(BundleState start, double loss) const {
  return solve(std::move(start), nullptr, Sigmas(views_.size(), 1), loss);
}

BundleFit Bundle::solve(BundleState start, const std::vector<int>* fixed, const Sigmas& sigmas, double loss) const {
  BundleFit out{std::move(start), false, 0};
  // Ceres would complain on standard error.
  for (std::size_t view = 0; view < views_.size(); ++view)
    if (view_used_[view] && !shows(out.state, view)) return out;
  ceres::Problem::Options borrowed;
  borrowed.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  borrowed.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  std::vector<std::unique_ptr<ceres::LossFunction>> losses;
  for (const double sigma : sigmas)
    losses.push_back(std::make_unique<ceres::ScaledLoss>(loss > 0 ? new ceres::HuberLoss(loss * sigma) : nullptr,
                                                         1 / (sigma * sigma), ceres::TAKE_OWNERSHIP));
  ceres::Problem problem(borrowed);
  auto* ordering = new ceres::ParameterBlockOrdering;
  double* camera = out.state.camera.data();
  int blocks = 0;
  for (std::size_t view = 0; view < views_.size(); ++view) {
    double* pose = out.state.poses[view].data();
    bool is_used = false;
    for (std::size_t point = 0; point < views_[view].points.size(); ++point) {
      if (!uses(view, point)) continue;
      problem.AddResidualBlock(costs_->of[view][point].get(), losses[view].get(), camera, pose);
      is_used = true;
      ++blocks;
    }
    if (is_used) ordering->AddElementToGroup(pose, 0);
  }
  ceres::Solver::Options options;
  options.linear_solver_ordering.reset(ordering);
  if (blocks == 0) return out;
  ordering->AddElementToGroup(camera, 1);
  if (fixed == nullptr)
    problem.SetParameterBlockConstant(camera);
  else if (!fixed->empty())
    problem.SetManifold(camera, new ceres::SubsetManifold(static_cast<int>(out.state.camera.size()), *fixed));
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = kMostSteps;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-11;
  options.gradient_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  out.converged = summary.IsSolutionUsable();
  out.cost = summary.final_cost;
  return out;
}

std::vector<std::optional<Eigen::Vector2d>> Bundle::residuals(const BundleState& state, std::size_t view) const {
  std::vector<std::optional<Eigen::Vector2d>> out;
  const double* parameters[] = {state.camera.data(), state.poses[view].data()};
  for (const auto& cost : costs_->of[view]) {
    Eigen::Vector2d residual;
    const bool exists = cost->Evaluate(parameters, residual.data(), nullptr);
    out.push_back(exists ? std::optional(residual) : std::nullopt);
  }
  return out;
}

bool Bundle::shows(const BundleState& state, std::size_t view) const {
  const auto all = residuals(state, view);
  for (std::size_t point = 0; point < all.size(); ++point)
    if (uses(view, point) && !(all[point] && all[point]->allFinite())) return false;
  return true;
}

Eigen::MatrixXd Bundle::information(const BundleState& state, const Sigmas& sigmas) const {
  const auto n = static_cast<Eigen::Index>(state.camera.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor> by_camera(2, n);
  Eigen::Matrix<double, 2, 6, Eigen::RowMajor> by_pose;
  double* jacobians[] = {by_camera.data(), by_pose.data()};
  for (std::size_t view = 0; view < views_.size(); ++view) {
    const double sigma = sigmas[view];
    Eigen::MatrixXd camera = Eigen::MatrixXd::Zero(n, n), mixed = Eigen::MatrixXd::Zero(n, 6);
    Eigen::Matrix<double, 6, 6> pose = Eigen::Matrix<double, 6, 6>::Zero();
    const double* parameters[] = {state.camera.data(), state.poses[view].data()};
    for (std::size_t point = 0; point < views_[view].points.size(); ++point) {
      Eigen::Vector2d residual;
      if (!uses(view, point) || !costs_->of[view][point]->Evaluate(parameters, residual.data(), jacobians)) continue;
      camera += by_camera.transpose() * by_camera;
      mixed += by_camera.transpose() * by_pose;
      pose += by_pose.transpose() * by_pose;
    }
    if (used_points(view) > 0) sum += (camera - mixed * pose.ldlt().solve(mixed.transpose())) / (sigma * sigma);
  }
  return sum;
}

}  // namespace tassilo
