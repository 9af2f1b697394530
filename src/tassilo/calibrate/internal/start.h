#pragma once

#include <optional>
#include <span>

#include "tassilo/calibrate/internal/bundle.h"

namespace tassilo {

/// A camera with the poses of those views that have one so far.
struct Start {
  BundleState state;
  std::vector<bool> placed;  ///< One a view.
};

/// A camera of the division model that roughly explains the views, with their poses, from nothing: over a grid of
/// coefficients and pixel aspects the points are undistorted about the middle of the image; the homographies that then
/// fit best give focal lengths and poses (Zhang 2000). The best few are adjusted. Views that
/// no homography places are placed by the camera the others give. Nothing when no guess works.
std::optional<Start> start_from_homographies(ImageSize size, std::span<const TargetView> views);

/// The coefficients of another model that bend rays like a division camera within the image, by linear least squares;
/// pinhole parameters and poses stay. `fixed` ones are 0.
std::optional<BundleState> convert_start(const BundleState& division, ImageSize size, LensModel model,
                                         std::span<const int> fixed);

/// The pose of one more view for a camera that is known; nothing when no start leads to one.
std::optional<PoseVector> start_pose(const CameraModel& camera, const TargetView& view);

}  // namespace tassilo
