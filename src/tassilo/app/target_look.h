#pragma once

#include <span>

#include "tassilo/calibrate/target.h"
#include "tassilo/files/png.h"
#include "tassilo/image/frame.h"

namespace tassilo {

/// The brightness of a frame as a picture of its own; O(pixels).
GrayImage gray_of(const FrameView& view);

/// Looks for each target, of whatever kind, until one is there; the one place where programs look for targets.
///
/// targets   each checked
/// returns   the first that is found, or why there is none, for each of them
/// cost      that of `find_target` for each; pure, safe from any thread. Throws Error for a bad target.
TargetSearch find_any_target(const GrayImage& image, std::span<const Target> targets);

}  // namespace tassilo
