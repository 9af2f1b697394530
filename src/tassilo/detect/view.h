#pragma once

#include "tassilo/camera/ground_map.h"
#include "tassilo/camera/mount.h"
#include "tassilo/color/segment.h"
#include "tassilo/field/field_model.h"
#include "tassilo/image/frame.h"
#include "tassilo/surface/surface.h"

namespace tassilo {

/// A calibrated, mounted camera with what is computed from it once.
struct Optics {
  Optics(const MountedCamera& mounted, const MountSigma& sigma)
      : camera(mounted), ground(mounted), mount_sigma(sigma) {}

  MountedCamera camera;
  GroundMap ground;
  MountSigma mount_sigma;
};

/// All that a detector may look at in one frame; borrowed for one call.
struct View {
  const FrameView& frame;
  const Segmentation& segmentation;
  const Surface& surface;
  const FieldModel& field;
  const Optics* optics = nullptr;  ///< Null without calibration.

  ColorClass color(int column, int row) const { return static_cast<ColorClass>(segmentation.label(column, row)); }
  bool inside(int column, int row) const {
    return column >= 0 && row >= 0 && column < segmentation.width && row < segmentation.height;
  }
};

/// Colors a robot shows: what hides a ball or a goal, and is no floor.
constexpr bool is_robot_color(ColorClass color) {
  return color == ColorClass::black || color == ColorClass::cyan || color == ColorClass::magenta;
}

/// Furthest two places of a field may lie apart; what stands further off stands off the field. [m]
double longest_distance(const FieldModel& field);

}  // namespace tassilo
