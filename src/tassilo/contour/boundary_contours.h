#pragma once

#include "tassilo/base/recycled.h"
#include "tassilo/contour/contour.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// One border of a region, through the centres of its own border pixels; always closed.
struct BoundaryContour {
  Contour contour;
  bool hole = false;  ///< Borders a hole; else the outside of an 8-connected part.
};

/// All borders of a region, with 8-connected foreground and 4-connected background. HALCON `gen_contour_region_xld`
/// with 'center' or, for holes, 'border_holes'; OpenCV `findContours` with RETR_CCOMP and CHAIN_APPROX_NONE.
///
/// Walking along the points, the region is to the right as seen on the screen: outer borders run clockwise, those of
/// holes counter-clockwise. From point to point it is one pixel along an axis or along a diagonal; where the region is
/// one pixel wide, both ways are walked. One pixel is a border of one point. The `length`s of outer borders sum up to
/// `contour_length` of the region. Ordered by the topmost, then leftmost pixel of each that has the border to its left,
/// where the border also begins.
///
/// cost     O(R + rows of the bounding box + border pixels * log of the runs in a row); safe from any thread.
/// source   own: follows the cracks between pixels
RecycledVector<BoundaryContour> boundary_contours(const Region& region);

}  // namespace tassilo
