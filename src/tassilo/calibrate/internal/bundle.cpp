#include "tassilo/calibrate/internal/bundle.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "tassilo/calibrate/internal/dot_image.h"
#include "tassilo/calibrate/internal/lens.h"

namespace tassilo {
namespace {

constexpr int kMostSteps = 100;

/// Standard deviation of how far lenses are from a division lens, relative to the radius at the image corner: twice
/// that of the projections that lenses are designed by. Fitted as by `OrdinaryCost`: stereographic 0, equidistant up to
/// 86 degrees .03, orthographic up to 64 degrees .035, equisolid up to 89 degrees .045.
constexpr double kUnlikeDivision = .1;
constexpr int kPriorRadii = 4;       ///< From the axis to the corner; a curve's few degrees of freedom.
constexpr double kMostPrior = 1.48;  ///< Division lenses end short of 90 degrees. [rad]
constexpr double kFrameLoss = 3;     ///< In standard deviations.

/// Where a point (x, y) on a target shows; false where there is no image of it.
template <class Lens, class T>
bool shown(const T* camera, const T* pose, const T (&target)[3], T* pixel) {
  T optical[3];
  ceres::AngleAxisRotatePoint(pose, target, optical);
  for (int i = 0; i < 3; ++i) optical[i] += pose[3 + i];
  T distorted[2];
  if (!Lens::distort(camera + kPinholeCount, optical, distorted)) return false;
  pixel[0] = camera[0] * distorted[0] + camera[2];
  pixel[1] = camera[1] * distorted[1] + camera[3];
  return true;
}

/// One point of a target: measured less computed.
template <class Lens>
struct PointCost {
  Eigen::Vector2d on_target, seen;
  double radius;  ///< Of a dot, 0 of a corner. [m]

  template <class T>
  bool shown_at(const T* camera, const T* pose, double x, double y, T* pixel) const {
    const T target[3] = {T(x), T(y), T(0)};
    return shown<Lens>(camera, pose, target, pixel);
  }

  template <class T>
  bool operator()(const T* camera, const T* pose, T* residual) const {
    T pixel[2];
    const auto shows = [&](double x, double y, T* at) { return shown_at(camera, pose, x, y, at); };
    const bool is_seen = radius > 0 ? disc_centroid(on_target.x(), on_target.y(), radius, shows, pixel)
                                    : shows(on_target.x(), on_target.y(), pixel);
    if (!is_seen) return false;
    residual[0] = seen.x() - pixel[0];
    residual[1] = seen.y() - pixel[1];
    return true;
  }
};

/// One place on a frame's side: measured less computed, across it.
template <class Lens>
struct FrameCost {
  FramePlace place;
  double pitch, last;  ///< last: the outer dot's column or row where the side is behind it, else 0.

  template <class T>
  bool operator()(const T* camera, const T* pose, const T* frame, T* residual) const {
    const bool is_row = place.side == FrameSide::top || place.side == FrameSide::bottom;
    const bool is_first = place.side == FrameSide::top || place.side == FrameSide::left;
    const T distance = frame[static_cast<int>(place.side)];
    const T across = pitch * (is_first ? -distance : last + distance), along = T(place.along * pitch);
    const T target[3] = {is_row ? along : across, is_row ? across : along, T(0)};
    T pixel[2];
    if (!shown<Lens>(camera, pose, target, pixel)) return false;
    residual[0] = place.normal.x * (place.pixel.x - pixel[0]) + place.normal.y * (place.pixel.y - pixel[1]);
    return true;
  }
};

/// How a lens differs from a division lens in one direction, in standard deviations.
template <class Lens>
struct OrdinaryCost {
  double angle;  ///< From the axis. [rad]
  double share;  ///< Of the way to the farthest corner, in the image.

  template <class T>
  bool operator()(const T* camera, const T* division, T* residual) const {
    const T point[3] = {T(std::sin(angle)), T(0.), T(std::cos(angle))};
    T radial[Lens::kCoefficients], shown[2], ordinary[2];
    std::copy(camera + kPinholeCount, camera + kPinholeCount + Lens::kCoefficients, radial);
    if constexpr (std::is_same_v<Lens, PlumbBobLens>) radial[2] = radial[3] = T(0.);
    if (!Lens::distort(radial, point, shown) || !DivisionLens::distort(division, point, ordinary)) return false;
    residual[0] = (shown[0] / ordinary[0] - 1.) / (kUnlikeDivision * share * share);
    return true;
  }
};

std::unique_ptr<ceres::CostFunction> cost_of(LensModel model, const Target& target, const FramePlace& place) {
  const double last = place.side == FrameSide::bottom ? target.rows - 1 : target.columns - 1;
  return with_lens(model, [&](auto lens) -> std::unique_ptr<ceres::CostFunction> {
    using Lens = decltype(lens);
    using Cost = FrameCost<Lens>;
    return std::make_unique<ceres::AutoDiffCostFunction<Cost, 1, kPinholeCount + Lens::kCoefficients, 6, 4>>(
        new Cost{place, target.pitch, last});
  });
}

std::unique_ptr<ceres::CostFunction> cost_of(LensModel model, const Target& target, const SeenPoint& point) {
  const TargetPoint on_target = target.at(point.column, point.row);
  return with_lens(model, [&](auto lens) -> std::unique_ptr<ceres::CostFunction> {
    using Lens = decltype(lens);
    using Cost = PointCost<Lens>;
    return std::make_unique<ceres::AutoDiffCostFunction<Cost, 2, kPinholeCount + Lens::kCoefficients, 6>>(
        new Cost{{on_target.x, on_target.y}, {point.pixel.x, point.pixel.y}, target.radius});
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
  std::vector<std::vector<std::unique_ptr<ceres::CostFunction>>> of;     ///< By view and point.
  std::vector<std::vector<std::unique_ptr<ceres::CostFunction>>> frame;  ///< By view and place.
  std::vector<std::unique_ptr<ceres::CostFunction>> ordinary;
};

Bundle::Bundle(LensModel model, std::span<const TargetView> views)
    : model_(model),
      views_(views),
      view_used_(views.size(), true),
      frame_sigmas_(views.size()),
      costs_(std::make_unique<Costs>()) {
  for (const TargetView& view : views) {
    point_used_.emplace_back(view.points.size(), true);
    auto& costs = costs_->of.emplace_back();
    for (const SeenPoint& point : view.points) costs.push_back(cost_of(model, view.target, point));
    place_used_.emplace_back(view.frame.size(), true);
    auto& frame_costs = costs_->frame.emplace_back();
    for (const FramePlace& place : view.frame) frame_costs.push_back(cost_of(model, view.target, place));
  }
}

Bundle::~Bundle() = default;

void Bundle::expect_ordinary_lens(ImageSize size, std::span<const double> division) {
  if (model_ == LensModel::division) return;
  const CameraModel camera = camera_from(size, LensModel::division, division);
  const double farthest = std::hypot(std::max(camera.cx, size.width - 1 - camera.cx) / camera.fx,
                                     std::max(camera.cy, size.height - 1 - camera.cy) / camera.fy);
  costs_->ordinary.clear();
  for (int i = 1; i <= kPriorRadii; ++i) {
    const double share = static_cast<double>(i) / kPriorRadii;
    const auto ray = unproject(camera, {camera.cx + share * farthest * camera.fx, camera.cy});
    const double angle = ray ? std::atan2(std::hypot(ray->x, ray->y), ray->z) : kMostPrior;
    if (!(angle < kMostPrior)) break;
    with_lens(model_, [&](auto lens) {
      using Lens = decltype(lens);
      using Cost = OrdinaryCost<Lens>;
      costs_->ordinary.push_back(
          std::make_unique<ceres::AutoDiffCostFunction<Cost, 1, kPinholeCount + Lens::kCoefficients, 1>>(
              new Cost{angle, share}));
    });
  }
  expects_ordinary_ = costs_->ordinary.size() > 1;
}

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
  std::vector<std::unique_ptr<ceres::LossFunction>> frame_losses;
  for (const FrameSigmas& sides : frame_sigmas_)
    for (const double sigma : sides) {
      const double by = sigma > 0 ? sigma : 1;
      frame_losses.push_back(std::make_unique<ceres::ScaledLoss>(new ceres::HuberLoss(kFrameLoss * by), 1 / (by * by),
                                                                 ceres::TAKE_OWNERSHIP));
    }
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
    // Poses in a fit of their own are those of the points.
    for (std::size_t place = 0; fixed != nullptr && place < views_[view].frame.size(); ++place) {
      if (!uses_frame_place(view, place)) continue;
      double* frame = out.state.frames[view].data();
      problem.AddResidualBlock(costs_->frame[view][place].get(), frame_losses[4 * view + side_of(view, place)].get(),
                               camera, pose, frame);
      if (!ordering->IsMember(frame)) ordering->AddElementToGroup(frame, 1);
      is_used = true;
      ++blocks;
    }
    if (is_used) ordering->AddElementToGroup(pose, 0);
  }
  ceres::Solver::Options options;
  options.linear_solver_ordering.reset(ordering);
  if (blocks == 0) return out;
  ordering->AddElementToGroup(camera, 1);
  for (std::size_t i = 0; fixed != nullptr && expects_ordinary_ && i < costs_->ordinary.size(); ++i) {
    problem.AddResidualBlock(costs_->ordinary[i].get(), nullptr, camera, &out.state.division);
    if (!ordering->IsMember(&out.state.division)) ordering->AddElementToGroup(&out.state.division, 1);
  }
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

std::vector<std::optional<double>> Bundle::frame_residuals(const BundleState& state, std::size_t view) const {
  std::vector<std::optional<double>> out;
  if (state.frames.empty()) return std::vector<std::optional<double>>(views_[view].frame.size());
  const double* parameters[] = {state.camera.data(), state.poses[view].data(), state.frames[view].data()};
  for (const auto& cost : costs_->frame[view]) {
    double residual = 0;
    const bool exists = cost->Evaluate(parameters, &residual, nullptr) && std::isfinite(residual);
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

Eigen::MatrixXd Bundle::information(const BundleState& state, const Sigmas& sigmas,
                                    std::span<const FrameSigmas> frame_sigmas) const {
  const auto n = static_cast<Eigen::Index>(state.camera.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor> by_camera(2, n);
  Eigen::Matrix<double, 2, 6, Eigen::RowMajor> by_pose;
  double* jacobians[] = {by_camera.data(), by_pose.data()};
  Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor> place_by_camera(1, n), by_view(1, 10);
  double* place_jacobians[] = {place_by_camera.data(), by_view.data(), by_view.data() + 6};
  for (std::size_t view = 0; view < views_.size(); ++view) {
    if (used_points(view) == 0) continue;
    // What a view has for itself: pose, then frame.
    Eigen::MatrixXd camera = Eigen::MatrixXd::Zero(n, n), mixed = Eigen::MatrixXd::Zero(n, 10);
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(10, 10);
    const double weight = 1 / (sigmas[view] * sigmas[view]);
    const double* parameters[] = {state.camera.data(), state.poses[view].data()};
    for (std::size_t point = 0; point < views_[view].points.size(); ++point) {
      Eigen::Vector2d residual;
      if (!uses(view, point) || !costs_->of[view][point]->Evaluate(parameters, residual.data(), jacobians)) continue;
      camera += weight * by_camera.transpose() * by_camera;
      mixed.leftCols<6>() += weight * by_camera.transpose() * by_pose;
      own.topLeftCorner<6, 6>() += weight * by_pose.transpose() * by_pose;
    }
    for (std::size_t place = 0; place < views_[view].frame.size(); ++place) {
      if (!uses_frame_place(view, place)) continue;
      const double* with_frame[] = {state.camera.data(), state.poses[view].data(), state.frames[view].data()};
      double residual = 0;
      if (!costs_->frame[view][place]->Evaluate(with_frame, &residual, place_jacobians)) continue;
      const double sigma = frame_sigmas[view][side_of(view, place)], place_weight = 1 / (sigma * sigma);
      camera += place_weight * place_by_camera.transpose() * place_by_camera;
      mixed += place_weight * place_by_camera.transpose() * by_view;
      own += place_weight * by_view.transpose() * by_view;
    }
    for (Eigen::Index side = 6; side < 10; ++side)
      if (own(side, side) == 0) own(side, side) = 1;  // a side without places
    sum += camera - mixed * own.ldlt().solve(mixed.transpose());
  }
  if (expects_ordinary_) {
    Eigen::MatrixXd slopes(static_cast<Eigen::Index>(costs_->ordinary.size()), n + 1);
    for (std::size_t i = 0; i < costs_->ordinary.size(); ++i) {
      Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor> by_lens(1, n);
      double residual = 0, by_division = 0;
      double* lens_jacobians[] = {by_lens.data(), &by_division};
      const double* parameters[] = {state.camera.data(), &state.division};
      const bool exists = costs_->ordinary[i]->Evaluate(parameters, &residual, lens_jacobians);
      const auto row = static_cast<Eigen::Index>(i);
      slopes.row(row).setZero();
      if (!exists) continue;
      slopes.row(row).head(n) = by_lens;
      slopes(row, n) = by_division;
    }
    const Eigen::VectorXd by_division = slopes.col(n);
    const Eigen::MatrixXd by_lens = slopes.leftCols(n);
    const Eigen::VectorXd mixed = by_lens.transpose() * by_division;
    if (by_division.squaredNorm() > 0)
      sum += by_lens.transpose() * by_lens - mixed * mixed.transpose() / by_division.squaredNorm();
  }
  return sum;
}

}  // namespace tassilo
