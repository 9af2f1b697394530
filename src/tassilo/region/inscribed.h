#pragma once

#include "tassilo/region/enclosing.h"
#include "tassilo/region/region.h"

namespace tassilo {

// Shapes inside a region; all 0 for the empty one. All are pure and safe from any thread.

/// The largest circle inside: its centre is the pixel of the region that is farthest from all pixels outside (the first
/// one in the region's order where several are), its radius that distance between centres less .5, half of the pixel
/// outside. So `disc(radius)` moved there lies in the region; a box of 2k + 1 pixels has radius k + .5. HALCON
/// `inner_circle`; OpenCV `distanceTransform` and `minMaxLoc`. Limits of the region and cost as `distance_inside`.
Circle inner_circle(const Region& region);

/// The axis-parallel box of most pixels that lies in the region; of several the same one in every call. HALCON
/// `inner_rectangle1`. O(pixels of the bounding box).
/// source   Morgan, "Programming from Specifications", 1990, the largest rectangle under a histogram, row by row.
PixelBox inner_rectangle(const Region& region);

}  // namespace tassilo
