#pragma once

#include "tassilo/camera/camera_model.h"
#include "tassilo/geometry/point.h"

namespace tassilo {

using RobotPoint = Point3<RobotFrame>;  ///< Point or direction in the robot frame.

/// The camera body frame (x forward, y left, z up) in the robot frame, R = Rz(yaw) Ry(pitch) Rx(roll);
/// pitch > 0 looks down. The optical axes in the body frame are X = -y, Y = -z, Z = x.
struct CameraMount {
  double x = 0, y = 0, z = 0;           ///< Optical centre in the robot frame. [m]
  double roll = 0, pitch = 0, yaw = 0;  ///< [rad]

  friend bool operator==(const CameraMount&, const CameraMount&) = default;
  /// Throws Error naming the first field out of range: all finite, z > 0, |angles| <= pi.
  void check() const;
};

/// One standard deviation of each mount value; how well the mount is known, shaking while driving included.
struct MountSigma {
  double x = 0.0, y = 0.0, z = 0.003;               ///< [m]
  double roll = 0.003, pitch = 0.003, yaw = 0.003;  ///< [rad]
};

/// A camera on a robot: pixel <-> ray from the optical centre, in the robot frame.
class MountedCamera {
 public:
  MountedCamera(CameraModel model, CameraMount mount);

  const CameraModel& model() const { return model_; }
  const CameraMount& mount() const { return mount_; }
  RobotPoint center() const { return {mount_.x, mount_.y, mount_.z}; }

  RobotPoint robot_from_optical(OpticalPoint direction) const;  ///< Rotates a direction.
  OpticalPoint optical_from_robot(RobotPoint direction) const;  ///< Rotates a direction.

  /// Pixel of a point in space, possibly outside the image; nothing when it cannot show.
  std::optional<PixelPoint> project(RobotPoint point) const;
  /// Unit direction of a pixel's ray in the robot frame.
  std::optional<RobotPoint> ray(PixelPoint pixel) const;
  /// Where the pixel's ray meets the horizontal plane at `height` (default: the floor) in front of the camera; nothing
  /// when it does not, or beyond `max_range` from the camera's foot, where a ray is as good as level. [m]
  std::optional<FloorPoint> floor_point(PixelPoint pixel, double height = 0, double max_range = 100) const;
  /// Likewise for a ray's direction in the robot frame, of any length.
  std::optional<FloorPoint> floor_along(RobotPoint direction, double height = 0, double max_range = 100) const;

 private:
  CameraModel model_;
  CameraMount mount_;
  double r_[3][3];  ///< robot_from_body
};

/// Where a camera has the place of the floor that shows where `at` showed, after its mount went from `from` to `to`;
/// nothing where no floor shows there any more. The lens does not matter. [m]
std::optional<FloorPoint> floor_point_moved(const CameraMount& from, const CameraMount& to, FloorPoint at);
/// What a change of the mount does to a robot: how far places of the floor at `range` from the camera's foot, ahead of
/// it and 30 degrees to both sides, move in its eyes. The farthest move; infinite where one is lost from the floor. [m]
double floor_shift(const CameraMount& from, const CameraMount& to, double range = 3);

}  // namespace tassilo
