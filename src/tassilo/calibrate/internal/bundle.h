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
  /// How far the middles of a frame's sides are from the outer dots, by FrameSide, one a view; empty while
  /// frames do not count. [pitch]
  std::vector<std::array<double, 4>> frames = {};
  /// Coefficient of the division model that is most like the lens, see Bundle::expect_ordinary_lens.
  double division = 0;
};

/// How well the points of each view are measured. [px]
using Sigmas = std::vector<double>;
/// The same of places on a frame, across it, by FrameSide; 0: the side does not count. [px]
using FrameSigmas = std::array<double, 4>;

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
  /// From now on the lens is believed to be like some division lens, as ordinary ones are: its radius at a direction
  /// differs by kUnlikeDivision at the farthest image corner, by less within, with the square of the radius. Weak where
  /// views say anything, it keeps coefficients from running away where none says anything. `division`: a camera of that
  /// model that fits the views.
  void expect_ordinary_lens(ImageSize size, std::span<const double> division);
  /// Places on the frame's sides count from now on, as measured with these sigmas. They say only that sides are
  /// straight and parallel to rows and columns: where they are is estimated, `state.frames`.
  void use_frame(std::size_t view, const FrameSigmas& sigmas) { frame_sigmas_[view] = sigmas; }
  void use_frame_place(std::size_t view, std::size_t place, bool used) { place_used_[view][place] = used; }
  bool uses_frame_place(std::size_t view, std::size_t place) const {
    return view_used_[view] && frame_sigmas_[view][side_of(view, place)] > 0 && place_used_[view][place];
  }
  void use_point(std::size_t view, std::size_t point, bool used) { point_used_[view][point] = used; }
  bool uses_view(std::size_t view) const { return view_used_[view]; }
  bool uses(std::size_t view, std::size_t point) const { return view_used_[view] && point_used_[view][point]; }
  bool is_inlier(std::size_t view, std::size_t point) const { return point_used_[view][point]; }
  std::size_t used_points(std::size_t view) const;

  /// Least squares from `start` over everything used. `fixed` lists camera parameters that stay; residuals are divided
  /// by their view's sigma, and beyond `loss` of that count linearly (Huber); 0: squares throughout.
  BundleFit fit(BundleState start, std::span<const int> fixed, const Sigmas& sigmas, double loss) const;
  /// Poses only, of all views that are used, by their points.
  BundleFit fit_poses(BundleState start, double loss) const;

  /// Measured less computed for each point of a view, used or not; nothing where no image exists. [px]
  std::vector<std::optional<Eigen::Vector2d>> residuals(const BundleState& state, std::size_t view) const;
  /// The same for places on the frame, across it; nothing while `state` has no frames.
  std::vector<std::optional<double>> frame_residuals(const BundleState& state, std::size_t view) const;
  /// Whether all used points of a view have an image.
  bool shows(const BundleState& state, std::size_t view) const;
  /// Inverse covariance of the camera's parameters, poses and frames being unknown, for points measured with `sigmas`
  /// and places on frames with `frame_sigmas`.
  Eigen::MatrixXd information(const BundleState& state, const Sigmas& sigmas,
                              std::span<const FrameSigmas> frame_sigmas) const;

 private:
  struct Costs;
  std::size_t side_of(std::size_t view, std::size_t place) const {
    return static_cast<std::size_t>(views_[view].frame[place].side);
  }
  BundleFit solve(BundleState start, const std::vector<int>* fixed, const Sigmas& sigmas, double loss) const;

  LensModel model_;
  std::span<const TargetView> views_;
  std::vector<bool> view_used_;
  std::vector<std::vector<bool>> point_used_, place_used_;
  std::vector<FrameSigmas> frame_sigmas_;
  bool expects_ordinary_ = false;
  std::unique_ptr<Costs> costs_;
};

}  // namespace tassilo
