#pragma once

#include "tassilo/geometry/point.h"
#include "tassilo/region/enclosing.h"
#include "tassilo/region/features.h"
#include "tassilo/region/region.h"

namespace tassilo {

// Shapes anywhere in the plane as regions: pixels whose centres lie in them or on their outlines, with 1e-9 px to
// spare, so that a shape that was fitted around pixels holds them all. With the shapes of enclosing.h, inscribed.h and
// features.h these are HALCON's `shape_trans`; 'rectangle1' and 'inner_rectangle1' are `Region::from_box`, 'convex' is
// `convex_region`. Results must stay within signed 16 bit (`expects`). O(rows), pure, safe from any thread.

/// HALCON `gen_circle`; `shape_trans` 'outer_circle', 'inner_circle'. radius >= 0.
Region circle_region(const Circle& circle);
/// HALCON `gen_ellipse`; `shape_trans` 'ellipse'. ra, rb >= 0.
Region ellipse_region(PixelPoint center, const EquivalentEllipse& ellipse);
/// HALCON `gen_rectangle2`; `shape_trans` 'rectangle2'. half_length, half_width >= 0.
Region rectangle_region(const RotatedRectangle& rectangle);

}  // namespace tassilo
