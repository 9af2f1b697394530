#pragma once

#include <optional>
#include <span>

#include "tassilo/field/field_curves.h"
#include "tassilo/localize/pose_belief.h"
#include "tassilo/scene/line_mark.h"
#include "tassilo/scene/scene.h"

namespace tassilo {

/// The field as the fit wants it, computed once.
struct FieldTarget {
  explicit FieldTarget(const FieldModel& model)
      : field(model), curves(field_curves(model)), extent(field_extent(model)) {}
  FieldModel field;
  FieldCurves curves;
  FieldExtent extent;
};
/// The goal of a color; null where the field has none.
const FieldModel::Goal* goal_of(const FieldTarget& target, GoalColor color);

/// What one frame tells of the pose; borrowed.
struct PoseObservation {
  std::span<const LineMark> marks;  ///< Of one line side by side.
  std::span<const Goal> goals;
  const FreeSpace* free_space = nullptr;  ///< Floor that is seen cannot lie behind a wall.
};

struct PoseFit {
  PoseGaussian pose;
  double log_likelihood = 0;  ///< Of what is seen; comparable between poses for one observation only.
  int lines_seen = 0, lines_explained = 0;
  int marks_seen = 0, marks_explained = 0;
  RecycledVector<int> line_of;  ///< By number of the seen line: index into curves.lines, or -1.
};

/// The pose near `prior` that explains marks and goals best, and how well: robust non-linear least squares on distances
/// across lines, the prior one measurement more. Each seen line belongs to one line of the field or to none.
///
/// cost     O(iterations x (marks + seen lines x field lines)), some 10 us; safe from any thread
/// source   Gauss-Newton with Cauchy weights; P. J. Huber, "Robust Statistics", 1981; own association
PoseFit fit_pose(const FieldTarget& target, const PoseObservation& seen, const PoseGaussian& prior);

/// The same for a prior so wide that several poses within it may explain what is seen: all of them, most likely first,
/// the last resort among them that nothing seen is of the field. Likelihoods are those of what is seen, times the share
/// of the prior's belief that a pose stands for, relative to the first one's share, less what each line costs that a
/// pose leaves unexplained: within one prior, more lines explained is likelier.
///
/// may_tilt   the robot may nod and roll by up to two degrees as it drives; counts where marks tell the eye
///
/// cost     a millisecond or two; safe from any thread
/// source   mixture with the weights of Laplace's method: D. MacKay, "Information Theory, Inference, and Learning
///          Algorithms", 2003, chapter 27; own
RecycledVector<PoseFit> fit_poses(const FieldTarget& target, const PoseObservation& seen, const PoseGaussian& prior,
                                  bool may_tilt);

/// Poses that explain a frame with nothing known before, best first: from pairs of lines that cross, the circle and a
/// line, goals and a line. Empty when what is seen does not tie all of x, y, theta down.
///
/// cost     some ms; safe from any thread
RecycledVector<PoseFit> search_poses(const FieldTarget& target, const PoseObservation& seen);

}  // namespace tassilo
