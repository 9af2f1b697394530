#pragma once

#include <array>

#include "tassilo/camera/mount.h"
#include "tassilo/scene/scene.h"

namespace tassilo {

/// Which pixels a ball covers. A sphere shows as an ellipse: pixels may not be square, and beside the optical axis a
/// lens stretches it; a circle of the mean radius leaves out its wide ends. O(1) a pixel.
///
/// source  own: the lens taken as linear around the ball's centre
class BallShape {
 public:
  BallShape(const MountedCamera& camera, const Ball& ball);

  /// Is the pixel on the ball, or at most `rim` beside it?
  bool covers(PixelPoint pixel, double rim) const;

 private:
  PixelPoint center_;
  double farthest_;                ///< No point of the outline is further from the centre. [px]
  std::array<double, 4> to_unit_;  ///< Row-major; makes the outline around the centre a circle of radius 1. [1/px]
};

}  // namespace tassilo
