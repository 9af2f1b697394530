#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tassilo/calibrate/mount_from_target.h"
#include "tassilo/camera/camera_model.h"
#include "tassilo/camera/mount.h"
#include "tassilo/field/field_curves.h"
#include "tassilo/geometry/point.h"

namespace tassilo {

/// A line of the field, the foot of a wall or a circle as one frame shows it.
struct SeenCurve {
  bool is_arc = false;
  std::size_t curve = 0;           ///< Index into the curves' lines, or arcs: which one it was taken for.
  std::vector<PixelPoint> points;  ///< On its middle; the foot of a wall. [px]
  double sigma_px = .3;            ///< Of one point, across, by itself. [px]
};

/// One frame, and about where the robot was. The point-mirrored pose will do: lines look the same from there.
struct LineFrame {
  double x = 0, y = 0, theta = 0;  ///< Field frame; right to some half meter and 10 degrees. [m, rad]
  std::vector<SeenCurve> curves;
};

struct MountFromLinesOptions {
  /// What all points of a line in one frame share: blur, and where the color changes; and what they share in all
  /// frames: the lens, worn paint, a wall that leans. [px], > 0
  double line_sigma_px = .3;
  /// Standard deviations beyond which a mount counts as not determined: a tenth of usual heights, and what moves a
  /// place 3 m away by half a meter. [m, rad], > 0
  double most_height_sigma = .05, most_angle_sigma = .025;
  void check() const;  ///< Throws Error naming the first field out of range.
};

struct MountFromLines {
  /// x, y and yaw are those of the start, with standard deviation 0: a camera that sits elsewhere on the robot sees the
  /// same from a robot that stands elsewhere.
  EstimatedMount estimate;
  double rms_px = 0;  ///< Root mean square distance of points from their lines, across. [px]
  std::size_t frames = 0, curves = 0, points = 0;  ///< That count in the end.
  std::size_t curves_thrown_out = 0;
  std::vector<PointResidual> residuals;  ///< Of all points, across their line.
};

/// Height, roll and pitch of a camera that sees lines of the field from places that need not be known.
///
/// Bundle adjustment of mount and poses: every point lies on its line. Lines that lie far from where all others put
/// them are thrown out. Standard deviations follow from the options' sigmas, or from the residuals where these are
/// larger.
///
/// start    about right: to two degrees and some centimetres
/// throws   Error when the lines do not determine height, roll and pitch, naming what stays open: lines of one
/// direction
///          do not; two that cross, or a line and the circle, in several frames do
/// cost     O(points x steps), some 100 ms for 40 frames; pure, one thread
/// source   own; sums of squares by Ceres
MountFromLines mount_from_lines(const MountedCamera& start, const FieldCurves& field, std::span<const LineFrame> frames,
                                const MountFromLinesOptions& options = {});

}  // namespace tassilo
