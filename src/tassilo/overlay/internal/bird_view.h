#pragma once

#include "tassilo/overlay/internal/canvas.h"
#include "tassilo/scene/scene.h"

namespace tassilo {

/// The scene from above into `place`: the robot at the bottom, x up, y left, rings of 1 m.
/// `range` ahead of the robot is in view at least. [m]
void draw_bird_view(Canvas& canvas, const Rect& place, const Scene& scene, double range);

}  // namespace tassilo
