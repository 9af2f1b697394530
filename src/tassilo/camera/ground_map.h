#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "tassilo/base/contract.h"
#include "tassilo/camera/mount.h"

namespace tassilo {

/// Pixel -> point on the floor for every pixel centre, computed once for a mounted camera.
///
/// cost     construction: one ray a pixel; look-ups O(1). 8 bytes a pixel.
/// threads  immutable after construction.
class GroundMap {
 public:
  explicit GroundMap(const MountedCamera& camera, double max_range = 100);

  int width() const { return width_; }
  int height() const { return height_; }
  /// Floor point at the pixel's centre; nothing at and above the horizon or beyond max_range. The pixel must be in the
  /// image.
  std::optional<FloorPoint> at(int column, int row) const {
    expects(column >= 0 && column < width_ && row >= 0 && row < height_, "GroundMap::at: the pixel is in the image");
    const Cell cell =
        cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column)];
    if (std::isnan(cell.x)) return std::nullopt;
    return FloorPoint{cell.x, cell.y};
  }

 private:
  struct Cell {
    float x, y;  ///< NaN where the ray does not meet the floor.
  };
  int width_ = 0, height_ = 0;
  std::vector<Cell> cells_;
};

/// Floor point (on the plane at `height`) of a pixel with its covariance from `pixel_sigma` (both directions) and the
/// mount's uncertainty, to first order. [px], [m]
std::optional<Gaussian2<RobotFrame>> floor_gaussian(const MountedCamera& camera, PixelPoint pixel, double pixel_sigma,
                                                    const MountSigma& mount_sigma, double height = 0);

}  // namespace tassilo
