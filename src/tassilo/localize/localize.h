#pragma once

#include <optional>

#include "tassilo/base/recycled_string.h"
#include "tassilo/localize/pose_belief.h"
#include "tassilo/localize/pose_fit.h"
#include "tassilo/scene/scene.h"
#include "tassilo/timeline/robot_motion.h"

namespace tassilo {

struct LocalizeOptions {
  double certain = 0.95;    ///< Share of belief at which one place is the pose. 0.5 .. 1
  int max_hypotheses = 12;  ///< >= 2
  void check() const;       ///< Throws Error naming the first field out of range.
};

/// A pose after a motion.
PoseGaussian moved(const PoseGaussian& pose, const RobotMotion& motion);

/// What was decided in one frame.
struct Localized {
  PoseBelief belief;
  std::optional<PoseSeen> pose;  ///< What may be told to others.
  RecycledVector<int> line_of;   ///< By seen line: index into the target's curves.lines, -1: none.
  RecycledString why;            ///< Short reason.
};

/// The belief at time t from the one before, the motion between and what is seen at t.
///
/// Each hypothesis is moved, fitted to what is seen and weighted by how well that fits. One that is wider than one
/// place (half a meter and 15 degrees, but for a twentieth) may hold several poses that do: all of them follow it.
/// Where there is none, or the best one has not explained what is seen for some frames, all poses that do are added.
/// Certain is what holds all but a twentieth of the belief and is no wider than one place; with the point-mirrored
/// place as rival, the pose is marked `mirror`.
///
/// source   multi-hypothesis Kalman filter: P. Jensfelt, S. Kristensen, "Active global localization for a mobile robot
///          using multiple hypothesis tracking", IEEE T-RA 17(5), 2001; own
/// cost     some 20 us a hypothesis, a millisecond or two for a wide one; some ms where all poses are searched
Localized localize(const FieldTarget& target, const PoseBelief& before, const RobotMotion& motion,
                   const PoseObservation& seen, double t, const LocalizeOptions& options);

/// A pose as the scene has it, without mirror.
PoseSeen told_pose(const PoseGaussian& pose, PoseKind kind, double age);

/// A belief in one pose, as a start pose gives it.
PoseBelief belief_in(const PoseGaussian& pose, double t);

}  // namespace tassilo
