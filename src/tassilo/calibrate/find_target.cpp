#include "tassilo/calibrate/find_target.h"

#include "tassilo/calibrate/april_grid.h"
#include "tassilo/calibrate/checkerboard.h"
#include "tassilo/calibrate/dot_grid.h"

namespace tassilo {

TargetSearch find_target(ByteView image, const Target& target) {
  switch (target.kind) {
    case TargetKind::checkerboard:
      return find_checkerboard(image, target);
    case TargetKind::april_grid:
      return find_april_grid(image, target);
    case TargetKind::dots:
      break;
  }
  return find_dot_grid(image, target);
}

}  // namespace tassilo
