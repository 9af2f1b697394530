#pragma once

#include <optional>

#include "tassilo/camera/ground_map.h"
#include "tassilo/camera/mount.h"
#include "tassilo/camera/ray_map.h"
#include "tassilo/color/segment.h"
#include "tassilo/field/field_model.h"
#include "tassilo/image/frame.h"
#include "tassilo/surface/surface.h"

namespace tassilo {

/// A calibrated, mounted camera with what is computed from it once.
struct Optics {
  Optics(const MountedCamera& mounted, const MountSigma& sigma)
      : camera(mounted), ground(mounted), rays(mounted.model()), mount_sigma(sigma) {}

  /// Unit direction of a pixel's ray in the robot frame, as `camera.ray` but from the table.
  std::optional<RobotPoint> ray(PixelPoint pixel) const {
    const auto direction = rays.at(pixel);
    return direction ? std::optional(camera.robot_from_optical(*direction)) : std::nullopt;
  }

  MountedCamera camera;
  GroundMap ground;
  RayMap rays;
  MountSigma mount_sigma;
};

/// Colors a robot of this field shows, its body's and its markers': what hides a ball or a goal, and is no floor.
ClassBits robot_colors(const FieldModel::Robots& robots);

/// All that a detector may look at in one frame; borrowed for one call.
struct View {
  const FrameView& frame;
  const Segmentation& segmentation;
  const Surface& surface;
  const FieldModel& field;
  const Optics* optics = nullptr;  ///< Null without calibration.
  ClassBits robots = robot_colors(field.robots);

  ColorClass color(int column, int row) const { return static_cast<ColorClass>(segmentation.label(column, row)); }
  bool is_robot(ColorClass of) const { return (robots & class_bit(of)) != 0; }
  bool is_robot(int column, int row) const { return is_robot(color(column, row)); }
  /// Is the pixel in the image?
  bool inside(int column, int row) const {
    return column >= 0 && row >= 0 && column < segmentation.width && row < segmentation.height;
  }
};

/// Pixel that holds a place; nothing outside the image, however far. O(1).
struct GridPoint {
  int column = 0, row = 0;
};
std::optional<GridPoint> pixel_of(const View& view, PixelPoint place);

/// Floor point below what shows at a pixel, if it stands at horizontal distance `range` from the eye; nothing where the
/// pixel shows no direction, or looks straight up or down. [m]
std::optional<FloorPoint> floor_at_range(const MountedCamera& camera, PixelPoint pixel, double range);
/// Its height above the floor, likewise. [m]
std::optional<double> height_at_range(const MountedCamera& camera, PixelPoint pixel, double range);

/// Floor point below the camera. [m]
inline FloorPoint foot_of(const MountedCamera& camera) { return {camera.center().x, camera.center().y}; }

/// Furthest two places of a field may lie apart; what stands further off stands off the field. [m]
double longest_distance(const FieldModel& field);

}  // namespace tassilo
