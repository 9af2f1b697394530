#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tassilo/calibrate/target.h"
#include "tassilo/camera/camera_model.h"

namespace tassilo {

/// The lens models that can be calibrated, by the names of camera files.
enum class LensModel { division, plumb_bob, equidistant };
std::string_view to_string(LensModel model);

struct IntrinsicsOptions {
  LensModel model = LensModel::division;
  /// Radial coefficients that are estimated; the others stay 0. plumb_bob: 1..3, equidistant: 1..4; division has its
  /// one. 0: all the model has.
  int radial_terms = 0;
  bool tangential = true;  ///< plumb_bob: p1 and p2 are estimated; else they stay 0.
  /// A view is thrown out when its points lie this many times as far off as those of the middle one of all views; so is
  /// a point, by its view's kind of target. [1], > 1
  double outlier_ratio = 3;
  /// The sides of dot targets' frames count, as lines that are straight: they reach beyond the dots. Where they are is
  /// estimated. Frames that contradict the dots are left out, with a warning.
  bool frames = true;
  /// Where views leave radial coefficients open, lenses are believed to be like those of the division model, within
  /// 10 % of the radius at the image corner.
  bool ordinary_lens = true;
  int folds = 5;       ///< Of the cross-validation: calibrations without a share of the views; 0: none. >= 2 or 0
  void check() const;  ///< Throws Error naming the first field out of range.
};

/// Size of the images. [px]
struct ImageSize {
  int width = 0, height = 0;
};

/// Where a target was: a point p on it shows at optical_from_target * p.
struct TargetPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< [m]
  /// Between the target's plane and the image plane, 0 when seen head on. [rad]
  double tilt() const;
};

/// A point as measured and as the calibrated camera would show it.
struct PointResidual {
  PixelPoint seen;      ///< [px]
  PixelPoint residual;  ///< seen less computed. [px]
  bool used = true;     ///< False for outliers within a view that counts.
};

/// What became of a view, in the order of the views given.
struct ViewResult {
  /// Why it was thrown out; empty when it counts. Lower-case, no full stop.
  std::string rejected;
  TargetPose pose;    ///< Of views thrown out the last one known.
  double rms_px = 0;  ///< Root mean square distance of the used points. [px]
  std::vector<PointResidual> points;
};

/// An estimated number and its standard deviation.
struct EstimatedValue {
  std::string name;  ///< fx, fy, cx, cy, then coefficients as k1, p1.
  double value = 0, sigma = 0;
};

/// Where in the image there were points.
struct Coverage {
  int columns = 0, rows = 0;  ///< The image in equal cells.
  std::vector<int> points;    ///< In each cell, row by row.
  double share = 0;           ///< Of cells with points. 0..1
  /// How far from the principal point there were points, of the way to the farthest corner. 0..1
  double reach = 0;
};

struct Intrinsics {
  CameraModel camera;
  std::vector<EstimatedValue> values;
  /// Of `values`, in their order.
  Eigen::MatrixXd covariance;
  /// Root mean square distance between points measured and computed, over all used points. [px]
  double rms_px = 0;
  /// The same for views that were not used in the calibration they were compared with: of these only the pose was
  /// fitted. Nothing with too few views for it. [px]
  std::optional<double> cross_validated_rms_px;
  /// The largest standard deviation of where a direction shows, over a grid of places up to the image's corners and but
  /// for a rotation of the camera as a whole; infinite when the lens cannot be inverted at one of them. [px]
  double worst_sigma_px = 0;
  int frame_places = 0;         ///< Places on the sides of frames that were used.
  std::string frames_rejected;  ///< Why they were not, where there were some. Lower-case, no full stop.
  std::vector<ViewResult> views;
  Coverage coverage;
  std::vector<std::string> warnings;  ///< Lower-case, no full stop.
};

/// Where the points of views are, before there is a camera: `reach` stays 0. `size` has at least one pixel.
Coverage coverage_of(ImageSize size, std::span<const TargetView> views);

/// Least views that a calibration needs.
inline constexpr int kLeastViews = 3;

/// The camera that explains views of targets best.
///
/// Start: undistorted points by a search over division coefficients and pixel aspects, focal length and poses by
/// homographies with the principal point in the middle. Then bundle adjustment of camera and poses; circles are
/// compared by the centroids of their images, computed with perspective and lens. Views are weighted by how well their
/// points are measured, estimated along. Outliers among points and views are thrown out, each view with its reason.
/// Standard deviations follow from the residuals and from how much neighbors err alike.
///
/// views    of one camera that did not change; each valid, its points inside the image
/// throws   Error when fewer than kLeastViews views are usable or they do not determine the camera
/// cost     about a second for 30 views of 50 points, with 5 folds; pure, one thread.
/// source   Z. Zhang, "A flexible new technique for camera calibration", IEEE PAMI 22(11), 2000; A. W. Fitzgibbon,
///          "Simultaneous linear estimation of multiple view geometry and lens distortion", CVPR 2001, for the division
///          model; J. Heikkila, O. Silven, "A four-step camera calibration procedure with implicit image correction",
///          CVPR 1997, for the circles.
Intrinsics calibrate_intrinsics(ImageSize size, std::span<const TargetView> views,
                                const IntrinsicsOptions& options = {});

}  // namespace tassilo
