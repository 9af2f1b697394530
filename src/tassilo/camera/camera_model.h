#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "tassilo/geometry/point.h"

// To add a camera model: 1. a struct with its coefficients here; 2. `distort` and `undistort` for it in
// camera_model.cpp;
// 3. its name in `distortion_name`; 4. reading and writing in files/camera_file.cpp; 5. a row in camera_test.cpp's list
// of models. Nothing else knows the models apart.

namespace tassilo {

using OpticalPoint = Point3<OpticalFrame>;  ///< Point or direction in the optical frame.

/// Brown-Conrady, ROS `plumb_bob`, coefficients k1 k2 p1 p2 k3.
struct PlumbBob {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
  friend bool operator==(const PlumbBob&, const PlumbBob&) = default;
};
/// ROS `rational_polynomial`, coefficients k1 k2 p1 p2 k3 k4 k5 k6.
struct RationalPolynomial {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0, k4 = 0, k5 = 0, k6 = 0;
  friend bool operator==(const RationalPolynomial&, const RationalPolynomial&) = default;
};
/// Kannala-Brandt, ROS `equidistant`: theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8).
struct Equidistant {
  double k1 = 0, k2 = 0, k3 = 0, k4 = 0;
  friend bool operator==(const Equidistant&, const Equidistant&) = default;
};
/// Lenz / HALCON division model on normalized coordinates: x = xd / (1 + k rd^2); k < 0 is barrel distortion. [1]
struct Division {
  double k = 0;
  friend bool operator==(const Division&, const Division&) = default;
};

using Distortion = std::variant<PlumbBob, RationalPolynomial, Equidistant, Division>;

/// `distortion_model` in a camera_info file.
std::string_view distortion_name(const Distortion& distortion);

/// What the lens and the sensor do: pixel <-> ray. Pixels need not be square.
struct CameraModel {
  std::string name;
  int width = 0, height = 0;  ///< [px]
  double fx = 1, fy = 1;      ///< Focal length in column and row direction. [px]
  double cx = 0, cy = 0;      ///< Principal point. [px]
  Distortion distortion = PlumbBob{};

  friend bool operator==(const CameraModel&, const CameraModel&) = default;

  /// Throws Error naming the first field out of range (sizes and focal lengths > 0, everything finite, principal point
  /// within one image size of the image, the lens invertible up to the image corners).
  void check() const;
};

/// Where a point shows in the image; also outside the image bounds. Nothing for points at or behind the camera (for
/// equidistant: only the optical centre and directions beyond the model's invertible angle) and where the lens model
/// folds back on itself.
std::optional<PixelPoint> project(const CameraModel& camera, OpticalPoint point);

/// Unit direction that shows at `pixel`; the inverse of `project`. Nothing where no direction shows there.
/// Closed form for division, Newton iteration to machine precision for the others. Thread-safe, about .04 us for
/// division and .2 to .5 us for the others.
std::optional<OpticalPoint> unproject(const CameraModel& camera, PixelPoint pixel);

/// HALCON's area_scan_division parameters; f [m], kappa [1/m^2], sx, sy [m/px], cx, cy [px].
struct HalconDivision {
  double f = 0, kappa = 0, sx = 0, sy = 0, cx = 0, cy = 0;
  int width = 0, height = 0;
};
CameraModel from_halcon(const HalconDivision& parameters);
/// The inverse needs one length that pixels do not tell: the sensor's pixel width `sx`. [m/px]
/// Throws Error when the camera's distortion is not Division or sx <= 0.
HalconDivision to_halcon(const CameraModel& camera, double sx);

}  // namespace tassilo
