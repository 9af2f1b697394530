#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "tassilo/base/recycled_string.h"
#include "tassilo/localize/boundary.h"
#include "tassilo/localize/localize.h"
#include "tassilo/localize/pose_fit.h"

namespace tassilo {

/// A goal's pixels, for which lines of the boundary touch it.
struct GoalInImage {
  GoalColor color = GoalColor::yellow;
  Region region;
};

/// A segment of the boundary and the wall it was taken for.
struct WallMatch {
  std::size_t segment = 0;
  std::string_view wall;  ///< x_plus, x_minus, y_plus or y_minus.
};

/// The pose by at most two lines of the boundary.
struct BoundaryFix {
  RecycledVector<WallMatch> matches;  ///< None, one, or two across each other.
  std::optional<PoseGaussian> pose;   ///< The predicted one where no line counts; nothing where it stays unknown.
  PoseKind kind = PoseKind::predicted;
  int refused = 0;  ///< Lines that were taken for a wall, but lie too far from where it was expected.
  RecycledString why;
};

/// What a frame shows of the boundary; borrowed.
struct BoundaryObservation {
  std::span<const BoundarySegment> segments;  ///< Of find_boundary.
  std::span<const GoalInImage> goals;
  const MountedCamera& camera;
};

/// Takes segments for walls and corrects the pose by them (DESIGN 6.9, 6.10).
///
/// A segment whose pixels touch a goal's, both dilated, is that goal's end line; of several the longest on the floor.
/// The longest one within 90 +- 20 degrees of it is a side line, left or right as it lies beside the goal in the image.
/// Without a goal, the longest segment, and the longest across it, are the walls that turn the predicted orientation
/// least: right while that is wrong by less than 45 degrees. A pair that is not quite orthogonal is turned to the
/// closest that is. No line: the prediction. One: orientation and the distance from it; along it as predicted. Two:
/// all. Without prediction two are needed. A line far from where the prediction has it (one in a thousand) is refused.
///
/// predicted   the pose before the frame, moved by odometry; nothing while unknown
/// cost        O(segments^2 + runs); safe from any thread
BoundaryFix pose_by_boundary(const FieldTarget& target, const BoundaryObservation& seen,
                             const std::optional<PoseGaussian>& predicted);

/// The belief at time t by the boundary alone: `pose_by_boundary` frame after frame, one hypothesis. When lines were
/// refused in three frames of a row, the prediction is no longer trusted, but for which way it looks.
///
/// before   of this or of the other localization; what is not certain there is unknown here
Localized localize_by_boundary(const FieldTarget& target, const PoseBelief& before, const RobotMotion& motion,
                               const BoundaryObservation& seen, double t);

}  // namespace tassilo
