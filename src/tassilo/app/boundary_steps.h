#pragma once

#include <array>
#include <string_view>

#include "tassilo/camera/mount.h"
#include "tassilo/localize/boundary.h"
#include "tassilo/overlay/overlay.h"

namespace tassilo {

/// The steps of `find_boundary`, as `--overlay-step` names them.
inline constexpr std::array<std::string_view, 5> kBoundarySteps{
    "boundary_region", "boundary_contours", "boundary_pieces", "boundary_lines", "boundary_segments"};

/// What a step found, in the image. `step` is an index into kBoundarySteps; segments on the floor are projected back.
StepPicture boundary_step(const Boundary& boundary, std::size_t step, const MountedCamera& camera);

}  // namespace tassilo
