#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/calibrate/internal/bundle.h"
#include "tassilo/calibrate/intrinsics.h"

namespace tassilo {

inline constexpr std::size_t kLeastPoints = 12;  ///< In a view.

/// One calibration, from views to camera, weights and covariance; indices of views are those of the usable ones.
class Calibration {
 public:
  /// Borrows the views, which must be usable each by itself.
  Calibration(ImageSize size, const std::vector<TargetView>& views, const IntrinsicsOptions& options);

  /// Throws Error when too few views agree or they do not determine the camera.
  void run();

  const BundleState& state() const { return state_; }
  const Eigen::MatrixXd& covariance() const { return covariance_; }
  double rms() const;  ///< Root mean square distance over the used points. [px]
  ViewResult view_result(std::size_t v) const;
  /// See Intrinsics.
  int frame_places() const;
  const std::string& frames_rejected() const { return frames_rejected_; }
  std::optional<double> cross_validated();

 private:
  /// Root mean square distance over the inliers of the views marked. [px]
  double rms(const BundleState& state, const std::vector<bool>& marked) const;
  std::vector<bool> used_views() const;
  void fit(const BundleState& start, double loss);
  /// By kind of target, from the middle of all residuals, which a few outliers do not move.
  Sigmas robust_sigmas() const;
  std::size_t parameters() const;
  /// From the residuals' squares, for the share of them that the parameters took up. Each view has its own, with its
  /// kind's as a belief worth some residuals: edges along the pixel grid are measured worse than others.
  Sigmas estimated_sigmas() const;
  /// Marks outliers and throws out the worst view, until nothing changes.
  void throw_out();
  bool throw_out_worst();
  /// Gives views that the division model could not place a pose by the camera as it is now; whether there were any.
  bool place_others();
  void check_view_count() const;
  /// How much larger, by kind of target, the variance of what many points have in common is than that of independent
  /// ones: 1 + the correlations of each point's error with those of its 8 neighbors, never below 1. Paper that is bent
  /// or edges along the pixel grid make neighbors err alike, and standard deviations would promise too much.
  std::array<double, kTargetKinds> likeness() const;
  Eigen::MatrixXd covariance_now() const;
  /// Adds what the frames of dot targets say to a calibration by points that is done; goes back to it where both
  /// contradict each other.
  void add_frames();
  /// Standard deviations of places on frames by their residuals, which also tell outliers. False when none are left.
  bool weigh_frames();
  /// How much larger the variance of what neighbors on a side have in common is, like `likeness`.
  double frame_likeness() const;

  ImageSize size_;
  const std::vector<TargetView>& views_;
  IntrinsicsOptions options_;
  std::vector<int> fixed_;
  Bundle bundle_;
  std::vector<std::string> rejected_;  ///< One a view; empty for those that count.
  Sigmas sigmas_;
  std::vector<FrameSigmas> frame_sigmas_;  ///< One a view.
  std::string frames_rejected_;
  BundleState state_;
  Eigen::MatrixXd covariance_;
};

}  // namespace tassilo
