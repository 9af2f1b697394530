#pragma once

#include "tassilo/region/region.h"

namespace tassilo {

// More structuring elements for morphology.h, which has `rectangle` and `disc`. All are symmetric about their origin,
// pixel (0, 0), so dilation and erosion mean the same in every library. Pure, safe from any thread.

/// Pixels at most `radius` steps along rows and columns away; radius >= 0. 2 radius + 1 runs. [px]
Region diamond(int radius);

/// Pixels whose centres lie in the regular octagon with `radius` from its centre to its sides, as far as pixels allow:
/// |column| <= radius, |row| <= radius, |column| + |row| <= round(sqrt 2 radius); radius >= 0. Cheaper than a disc: an
/// octagon falls apart into fewer boxes. 2 radius + 1 runs. [px]
Region octagon(int radius);

/// How `line_element` lies.
struct LineShape {
  double length_px = 1;  ///< From end to end over pixel edges along the longer axis. [px], >= 1
  double angle = 0;      ///< Counter-clockwise on the screen from "right". [rad]
};
/// A straight line one pixel wide, 8-connected, through the origin: from -e to e, e = (length_px - 1) / 2 (cos angle,
/// -sin angle) rounded to a pixel, with one pixel for each column or row, whichever are more; halves are rounded away
/// from the origin. So the number of pixels is odd, and a turn by pi changes nothing.
Region line_element(const LineShape& shape);

}  // namespace tassilo
