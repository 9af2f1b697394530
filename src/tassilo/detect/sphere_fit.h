#pragma once

#include <optional>
#include <span>

#include "tassilo/base/recycled.h"
#include "tassilo/camera/mount.h"
#include "tassilo/field/field_model.h"
#include "tassilo/geometry/point.h"

namespace tassilo {

/// A sphere that rests on the floor.
struct RestingSphere {
  FloorPoint foot;    ///< Below its centre, where it touches the floor. [m]
  double radius = 0;  ///< [m]

  RobotPoint center() const { return {foot.x, foot.y, radius}; }
};

/// A place on a sphere's outline in the image.
struct OutlinePoint {
  PixelPoint at;       ///< [px]
  PixelPoint outward;  ///< Unit vector away from the ball.
};
/// `count` points of the outline, evenly around the axis of sight, from the right counter-clockwise as seen in an
/// upright image; those that cannot show are left out, all of them when the centre cannot, or the eye is inside the
/// sphere. O(count), one projection a point: outward is away from where the centre shows, which is off the radial
/// plane's picture only by how much the lens bends that over the ball's radius.
RecycledVector<OutlinePoint> outline(const MountedCamera& camera, const RestingSphere& sphere, int count);
/// The place straight below the centre as seen from the eye; `outward` points straight down there, too.
std::optional<OutlinePoint> lowest_of_outline(const MountedCamera& camera, const RestingSphere& sphere);

/// A sphere as a disc in the image.
struct ProjectedDisc {
  PixelPoint center;     ///< Where the sphere's centre shows. [px]
  double radius_px = 0;  ///< Mean distance of the outline from it. [px]
};
/// From `count` points of its outline already at hand; nothing when some are missing, or the centre cannot show.
std::optional<ProjectedDisc> disc_of(const MountedCamera& camera, const RestingSphere& sphere,
                                     std::span<const OutlinePoint> outline, int count);
/// Nothing when a part of the outline cannot show. O(1).
std::optional<ProjectedDisc> project_disc(const MountedCamera& camera, const RestingSphere& sphere);

/// What fit_resting_sphere found.
struct SphereFit {
  RestingSphere sphere;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();  ///< Of foot.x, foot.y, radius; from the edges alone.
  double rms_px = 0;                                         ///< Of the edges' distance from the fitted outline.
  double inlier_share = 0;                                   ///< Edges within three edge_sigma_px. [1]
};

struct SphereFitOptions {
  Interval radius;             ///< Prior of the radius: uniform between both. [m]
  double edge_sigma_px = 0.5;  ///< Of one edge point across the outline. [px]
  int iterations = 8;
  /// Where the fit may walk to on its way, from the eye; what is no ball on the floor often fits best at the horizon.
  double furthest = 1e3;  ///< [m], > 0
};

/// Fits a sphere that rests on the floor to points on its outline, by Gauss-Newton on their distance from the outline
/// with Huber weights; exact for every lens, for it compares angles between rays. Nothing when it does not converge to
/// a place that can show, or when the edges leave it open.
///
/// rays     through the outline, at least 3; unit directions, robot frame
/// start    a rough position
/// cost     O(rays x iterations), some 10 ns each; source: own
std::optional<SphereFit> fit_resting_sphere(const MountedCamera& camera, std::span<const RobotPoint> rays,
                                            const RestingSphere& start, const SphereFitOptions& options);
/// Likewise for pixels of the outline, at least 3, each undistorted first.
std::optional<SphereFit> fit_resting_sphere(const MountedCamera& camera, std::span<const PixelPoint> edges,
                                            const RestingSphere& start, const SphereFitOptions& options);

}  // namespace tassilo
