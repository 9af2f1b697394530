#pragma once

#include "tassilo/geometry/point.h"
#include "tassilo/scene/scene.h"

namespace tassilo {

/// A place on the middle of a field line or at the foot of a wall, as seen in one frame. What localization works on.
struct LineMark {
  FloorPoint at;
  FloorPoint across;        ///< Unit vector across the line on the floor; on the circle along its radius.
  double sigma = 0;         ///< Across, of this place alone. [m]
  double common_sigma = 0;  ///< Across, what all places of the line share. [m]
  LineKind kind = LineKind::line;
  int line = 0;  ///< Places of one line have the same number; kCircle: of the centre circle.
  static constexpr int kCircle = -1;
  Point3<RobotFrame> eye = {};  ///< Of the camera that saw it. z is 0 where that is unknown. [m]
};

}  // namespace tassilo
