#pragma once

#include "tassilo/calibrate/target.h"
#include "tassilo/region/raster.h"

namespace tassilo {

/// Finds a dot target in a gray image.
///
/// Dark regions by a local threshold; those that are ellipses by their moments; their order by a walk from neighbor to
/// neighbor, which neither perspective nor the lens disturbs; dot (0, 0) by the dark triangle beside it. Dots are
/// measured by gray-value moments, with the background as a plane: a centroid of the dot's image, good to some
/// hundredths of a pixel.
///
/// image    gray, any size; a dot should cover at least some 10 pixels
/// target   of kind dots; checked
/// returns  a view with at least 4 of 5 dots, some on each of the four sides, none cut by the image border; or why not
/// cost     some 20 ms for 640 x 480; pure, safe from any thread. Throws Error for a bad target.
TargetSearch find_dot_grid(ByteView image, const Target& target);

}  // namespace tassilo
