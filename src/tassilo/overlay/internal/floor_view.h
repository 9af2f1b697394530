#pragma once

#include <vector>

#include "tassilo/camera/mount.h"
#include "tassilo/overlay/internal/canvas.h"
#include "tassilo/scene/scene.h"

namespace tassilo {

/// Free space as it shows in the enlarged image.
struct FreeSpaceInImage {
  std::vector<std::vector<CanvasPoint>> floor;    ///< One polygon a sector that shows; neighbors share their edges.
  std::vector<std::vector<CanvasPoint>> blocked;  ///< Far edges where something blocks the way.
  std::vector<std::vector<CanvasPoint>> open;     ///< Far edges where only the view ends.
};

/// `scale` is the enlargement of the image; unseen sectors and what the lens does not show are left out.
FreeSpaceInImage project_free_space(const FreeSpace& space, const MountedCamera& camera, double scale);

/// Middle of an image pixel (or sub-pixel position) in the enlarged image.
inline CanvasPoint on_canvas(PixelPoint pixel, double scale) {
  return {(pixel.x + .5) * scale, (pixel.y + .5) * scale};
}

}  // namespace tassilo
