#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "tassilo/calibrate/intrinsics.h"

namespace tassilo {

/// Rotation vector, then translation [m]: optical_from_target.
using PoseVector = std::array<double, 6>;
TargetPose pose_from(const PoseVector& pose);

/// Camera parameters (see lens.h) and the targets' poses, one a view.
struct BundleState {
  std::vector<double> camera;
  std::vector<PoseVector> poses;
};

/// How well the points of each view are measured. [px]
using Sigmas = std::vector<double>;

struct BundleFit {
  BundleState state;
  bool converged = false;  ///< Not when a used point has no image at the start either.
  double cost = 0;         ///< Half the sum of squares, weighted, after the loss.
};

/// The adjustment of camera and poses to what views show; which points and views count may change between fits.
class Bundle {
 public:
  /// `views` is borrowed.
  Bundle(LensModel model, std::span<const TargetView> views);
  ~Bundle();
  Bundle(const Bundle&) = delete;
  Bundle& operator=(const Bundle&) = delete;

  void use_view(std::size_t view, bool used) { view_used_[view] = used; }
  void use_point(std::size_t view, std::size_t point, bool used) { point_used_[view][point] = used; }
  bool uses_view(std::size_t view) const { return view_used_[view]; }
  bool uses(std::size_t view, std::size_t point) const { return view_used_[view] && point_used_[view][point]; }
  bool is_inlier(std::size_t view, std::size_t point) const { return point_used_[view][point]; }
  std::size_t used_points(std::size_t view) const;

  /// Least squares from `start` over everything used. `fixed` lists camera parameters that stay; residuals are divided
  /// by their view's sigma, and beyond `loss` of that count linearly (Huber); 0: squares throughout.
  BundleFit fit(BundleState start, std::span<const int> fixed, const Sigmas& sigmas, double loss) const;
  /// Poses only, of all views that are used.
  BundleFit fit_poses(BundleState start, double loss) const;

  /// Measured less computed for each point of a view, used or not; nothing where no image exists. [px]
  std::vector<std::optional<Eigen::Vector2d>> residuals(const BundleState& state, std::size_t view) const;
  /// Whether all used points of a view have an image.
  bool shows(const BundleState& state, std::size_t view) const;
  /// Inverse covariance of the camera's parameters, poses being unknown, for points measured with `sigmas`.
  Eigen::MatrixXd information(const BundleState& state, const Sigmas& sigmas) const;

 private:
  struct Costs;
  BundleFit solve(BundleState start, const std::vector<int>* fixed, const Sigmas& sigmas, double loss) const;

  LensModel model_;
  std::span<const TargetView> views_;
  std::vector<bool> view_used_;
  std::vector<std::vector<bool>> point_used_;
  std::unique_ptr<Costs> costs_;
};

}  // namespace tassilo
