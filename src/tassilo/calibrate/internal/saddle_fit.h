#pragma once

#include <optional>

#include "tassilo/geometry/point.h"
#include "tassilo/region/raster.h"

namespace tassilo {

/// A corner of a checkerboard before it is measured: where about, and the steps to the next corners on its lines;
/// pixels within a part of these steps belong to it alone. [px]
struct RoughCorner {
  PixelPoint at, along, down;
  /// How the lines along and down are bent, and how well that is known: a line runs through the corner + s t - bend s^2
  /// n, with its unit tangent t = (x, y) and n = (-y, x). [1/px]
  double along_bend = 0, down_bend = 0, bend_sigma = .002;
};

/// The corner's place: the image around it is fitted by two smooth edges that cross, each slightly bent as lenses bend
/// lines, by Gauss-Newton. Nothing where the fit runs away or pixels are missing.
///
/// cost     some 10 us for small corners to 300 us for large ones. Own.
std::optional<PixelPoint> fitted_corner(ByteView image, const RoughCorner& corner);

}  // namespace tassilo
