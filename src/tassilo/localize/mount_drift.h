#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>

#include "tassilo/camera/mount.h"
#include "tassilo/localize/pose_belief.h"
#include "tassilo/localize/pose_fit.h"
#include "tassilo/scene/line_mark.h"

namespace tassilo {

struct MountDriftOptions {
  double memory = 20;  ///< Time constant: what is older counts less and less. [s], > 0
  /// Frames within this time count as one: errors of lines are others only when these show elsewhere. [s], > 0
  double alike_time = .5;
  double step = .1;           ///< Frames that follow sooner are not looked at, to save time. [s], >= 0
  double mark_sigma_px = .3;  ///< Of a place on a line by itself, [px], > 0
  double line_sigma_px = .3;  ///< and what all places of a line share. [px], > 0
  /// A drift is told when it moves a place of the floor 3 m away by more: about a ball's radius. [m], > 0
  double least_shift = .1;
  /// And when chance, without any drift, would be less likely than this, at any one time. Some hundred independent
  /// times an hour make that one false alarm in about a thousand hours. 0 .. 1, exclusive
  double false_alarm = 1e-5;
  void check() const;  ///< Throws Error naming the first field out of range.
};

/// What lines told so far of how a mount differs from what the camera file says. A value of fixed size.
struct MountDrift {
  CameraMount mount;  ///< What the camera file says; another one begins anew.
  double t = 0;       ///< Of the last frame. [s]
  /// Of height, roll and pitch: their differences are what solves information * difference = sum.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double square = 0;   ///< Of what single frames would have it, in standard deviations.
  double moments = 0;  ///< How many frames that err by themselves this comes from.
  bool begun = false;
};

/// What one frame tells of it; borrowed.
struct MountEvidence {
  const MountedCamera& camera;
  MountSigma nod;  ///< How much the robot shakes while driving, besides: VisionOptions::mount_sigma().
  std::span<const LineMark> marks;
  std::span<const int> line_of;  ///< By a mark's `line`: what the localization took it for, as Localized has it.
  PoseGaussian pose;             ///< Where the localization has the robot, by this mount.
  double t = 0;                  ///< Later than the frame before; else a new drive begins. [s]
};

/// The drift with one frame more. Where the localization explains less than four fifths of what is seen, lines are
/// taken for those of the field again, with indulgence, since a mount that has drifted spoils that; then pose and mount
/// are fitted together, and what is left of the mount when any pose will do is added. A frame with lines of one
/// direction adds next to nothing, and one that nothing explains adds nothing.
///
/// cost     some 20 us; safe from any thread
/// source   recursive least squares with exponential forgetting; own
MountDrift watched(const MountDrift& before, const FieldTarget& target, const MountEvidence& seen,
                   const MountDriftOptions& options = {});

/// A mount that has drifted: differences to what the camera file says, and standard deviations. [m, rad]
struct MountDrifted {
  double z = 0, roll = 0, pitch = 0;
  double z_sigma = 0, roll_sigma = 0, pitch_sigma = 0;
  double shift = 0;  ///< How far a place of the floor 3 m away is off. [m]
};
/// Nothing while it is not certain, or too little to matter.
std::optional<MountDrifted> drifted(const MountDrift& drift, const MountDriftOptions& options = {});
/// "pitch +0.8 deg (sigma 0.1), height -12 mm (sigma 3); places 3 m away are off by 17 cm": what is certain by itself.
std::string to_text(const MountDrifted& drifted);

}  // namespace tassilo
