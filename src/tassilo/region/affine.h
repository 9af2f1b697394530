#pragma once

#include "tassilo/geometry/point.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// An affine map of the image plane: (x, y) goes to (xx x + xy y + x0, yx x + yy y + y0). [px]
struct AffineMap {
  double xx = 1, xy = 0, x0 = 0;
  double yx = 0, yy = 1, y0 = 0;

  PixelPoint operator*(PixelPoint p) const { return {xx * p.x + xy * p.y + x0, yx * p.x + yy * p.y + y0}; }
  /// First `inner`, then `outer`.
  friend AffineMap operator*(const AffineMap& outer, const AffineMap& inner);
};

/// Turns about `center` by `angle`, counter-clockwise on the screen. [rad] HALCON `hom_mat2d_rotate`.
AffineMap rotation_about(PixelPoint center, double angle);

/// The region moved by the map, pixels seen as unit squares: those pixels whose centres lie in the mapped squares, so
/// whose centres mapped back are nearest to a pixel of the region; on the line between two, `region_from_polygon` says
/// which. A map without an inverse gives nothing. The result stays within signed 16 bit (`expects`). HALCON
/// `affine_trans_region` 'nearest_neighbor'; OpenCV `warpAffine` INTER_NEAREST; Leptonica `pixAffineSampled`.
/// O(E log E) for E crossings of the region's outlines with rows; pure, safe from any thread.
Region mapped(const Region& region, const AffineMap& map);

}  // namespace tassilo
