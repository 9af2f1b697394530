#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "tassilo/calibrate/intrinsics.h"
#include "tassilo/calibrate/target.h"
#include "tassilo/camera/camera_model.h"
#include "tassilo/camera/mount.h"

namespace tassilo {

/// Where a target lies on the floor, face up, as it was measured.
struct TargetPlace {
  /// Its origin, the first dot or inner corner, in the robot frame. [m]
  double x = 0, y = 0;
  /// From the robot's x axis to the target's, which runs along its columns; counter-clockwise from above. [rad]
  double yaw = 0;
  double height = 0;  ///< Of its face above the floor: the board's thickness. [m], >= 0

  friend bool operator==(const TargetPlace&, const TargetPlace&) = default;
  void check() const;  ///< Throws Error naming the first field out of range.
};

/// A view of a target, and where that lay.
struct PlacedView {
  TargetView view;
  std::size_t place = 0;  ///< Index into the places.
};

struct MountFromTargetOptions {
  /// How well places are measured: with a tape over a meter, and a board of 24 cm turned by 1 mm at each end. What they
  /// are wrong by, the mount is, too.
  double place_sigma = .002;         ///< Of x and y each. [m], > 0
  double place_yaw_sigma = .006;     ///< [rad], > 0
  double place_height_sigma = .001;  ///< Boards are not flat, nor are floors. [m], > 0
  /// Points are thrown out when they lie so many times as far off as usual. [1], > 1
  double outlier_ratio = 4;
  void check() const;  ///< Throws Error naming the first field out of range.
};

/// A mount as estimated from images.
struct EstimatedMount {
  CameraMount mount;
  /// Standard deviations. [m, rad]
  MountSigma sigma;
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< Of x, y, z, roll, pitch, yaw.
};

struct MountFromTarget {
  EstimatedMount estimate;
  double rms_px = 0;  ///< Root mean square distance over all used points. [px]
  /// In the order of the views given; `pose` is where the target was for the estimated mount, and nothing is rejected.
  std::vector<ViewResult> views;
  std::vector<std::string> warnings;  ///< Lower-case, no full stop.
};

/// The mount of a calibrated camera that sees targets which lie on the floor at known places.
///
/// Least squares over the mount and small corrections of the places, which are known as the options say; dots are
/// compared by the centroids of their images. Standard deviations follow from the residuals, from how much neighbors
/// err alike, and from how well the places are known; what the lens is wrong by is not in them. Height, roll and pitch
/// follow from the floor alone; x, y and yaw are as good as the places are measured.
///
/// camera   valid; of any lens model
/// places   each with at least one view
/// throws   Error when there is no view, a view has fewer than 12 points or all on one line, or nothing explains them:
///          the target seen does not lie on the floor, or another lens took the image
/// cost     some 10 ms a view; pure, one thread. source  own
MountFromTarget mount_from_target(const CameraModel& camera, std::span<const TargetPlace> places,
                                  std::span<const PlacedView> views, const MountFromTargetOptions& options = {});

/// A target at its place: robot_from_target * p for points p on the target.
TargetPose robot_from_target(const TargetPlace& place);
/// Where it shows to a mounted camera: optical_from_target.
TargetPose seen_by(const MountedCamera& camera, const TargetPlace& place);

}  // namespace tassilo
