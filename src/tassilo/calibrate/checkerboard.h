#pragma once

#include "tassilo/calibrate/target.h"
#include "tassilo/region/raster.h"

namespace tassilo {

/// Finds the inner corners of a checkerboard in a gray image.
///
/// Saddle points of the blurred image that alternate four times around themselves; their order by a walk from neighbor
/// to neighbor, which neither perspective nor the lens disturbs; then each is placed where all brightness gradients
/// around it are orthogonal to the direction from it, good to some hundredths of a pixel. Corner (0, 0) is beside the
/// black square in a corner.
///
/// image    gray, any size; squares should be at least some 6 pixels wide
/// target   of kind checkerboard; checked
/// returns  a view with at least 4 of 5 corners, some on each of the four sides; or why not
/// cost     some 60 ms for 640 x 480; pure, safe from any thread. Throws Error for a bad target.
/// source   W. Förstner, E. Gülch, "A fast operator for detection and precise location of distinct points, corners and
///          centres of circular features", ISPRS 1987, for the gradients; own.
TargetSearch find_checkerboard(ByteView image, const Target& target);

}  // namespace tassilo
