#pragma once

#include "tassilo/calibrate/target.h"
#include "tassilo/region/raster.h"

namespace tassilo {

/// `find_dot_grid`, `find_checkerboard` or `find_april_grid`, by the target's kind.
TargetSearch find_target(ByteView image, const Target& target);

}  // namespace tassilo
