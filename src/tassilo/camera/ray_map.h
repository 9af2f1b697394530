#pragma once

#include <optional>
#include <vector>

#include "tassilo/camera/mount.h"

namespace tassilo {

/// Pixel -> direction anywhere in the image, from a table, so that undoing the lens is paid once for a camera and not
/// for each point of each frame.
///
/// Directions are held at every other pixel and interpolated in between, which is off by about 1 / (4 f^2) radians, a
/// thousandth of a pixel for usual lenses: far below what noise and blur leave of any edge.
/// cost     construction: one ray for four pixels; look-ups some ns. 3 bytes a pixel.
/// threads  immutable after construction.
class RayMap {
 public:
  explicit RayMap(const CameraModel& camera);

  /// Unit direction that shows at `pixel`, optical frame; outside the image by `unproject`. Nothing where no direction
  /// shows there.
  std::optional<OpticalPoint> at(PixelPoint pixel) const;

 private:
  struct Node {
    float x, y, z;  ///< Unit; NaN where no direction shows.
  };
  CameraModel camera_;
  int columns_ = 0, rows_ = 0;  ///< Of nodes.
  std::vector<Node> nodes_;
};

}  // namespace tassilo
