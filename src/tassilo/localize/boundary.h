#pragma once

#include <optional>

#include "tassilo/base/recycled.h"
#include "tassilo/camera/mount.h"
#include "tassilo/camera/ray_map.h"
#include "tassilo/contour/contour.h"
#include "tassilo/image/frame.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// How the foot of the wall is found in the region where wall and field meet.
enum class BoundaryMethod {
  skeleton,  ///< The region's skeleton.
  subpixel,  ///< Edges of the brightness within the region.
};

struct BoundaryOptions {
  BoundaryMethod method = BoundaryMethod::skeleton;
  double reach_px = 3;              ///< How far wall and field are dilated: the blurred rim between them. [px], > 0
  double split_px = 1.5;            ///< A contour is cut where it leaves its chord by more. [px], > 0
  double min_length_px = 20;        ///< Shorter pieces are dropped. [px], > 1
  double max_inclination_deg = 80;  ///< Steeper pieces are rims of posts and robots. [deg], 0 < .. <= 90
  double join_angle_deg = 4;        ///< Pieces of one line in the image differ by less, [deg], > 0
  double join_offset_px = 2;        ///< and lie so near each other's line, [px], > 0
  double join_gap_px = 60;          ///< end to end. [px], > 0
  double floor_join_angle_deg = 5;  ///< The same on the floor. [deg], > 0
  double floor_join_offset = 0.1;   ///< [m], > 0
  double floor_join_gap = 1;        ///< [m], > 0
  void check() const;               ///< Throws Error naming the first field out of range.
};

/// A straight piece of the boundary in the image, undistorted: pixels of an ideal camera of the same focal length, with
/// the principal point at (0, 0).
struct BoundaryPiece {
  PixelPoint p, q;         ///< Ends on the regression line. [px]
  double residual_px = 0;  ///< Root mean square distance of the points from it.
  int points = 0;
  PixelPoint image_p, image_q;  ///< The contour's first and last point in the image as it is.
};

/// One on the floor.
struct BoundarySegment {
  FloorPoint p, q;
  double residual_px = 0;
  double sigma_px = 1;  ///< How well its ends are known across it. [px]
  int points = 0;
  PixelPoint image_p, image_q;
};

/// All steps from the region to segments on the floor, to be looked at.
struct Boundary {
  Region region;                             ///< Where wall and field meet.
  RecycledVector<Contour> contours;          ///< In the image.
  RecycledVector<BoundaryPiece> pieces;      ///< Straight, before some are dropped.
  RecycledVector<BoundaryPiece> lines;       ///< Long enough, not vertical, joined.
  RecycledVector<BoundarySegment> segments;  ///< Longest on the floor first.
};

/// Where the carpet ends at a wall, as straight segments on the floor (DESIGN 6.8): region of interest
/// dilate(wall) and dilate(field), contours, undistorted, split, regression lines, the vertical and the short ones
/// dropped, collinear ones joined, end points projected to the floor, collinear ones joined there.
///
/// wall, field   regions of the frame
/// cost          O(runs + points), some .1 ms; safe from any thread
/// source        R. Hanek, T. Schmitt, M. Klupsch, S. Buck, "From multiple images to a consistent view", RoboCup 2000
///               (LNAI 2019); lines by total least squares; U. Ramer, "An iterative procedure for the polygonal
///               approximation of plane curves", CGIP 1(3), 1972
Boundary find_boundary(const FrameView& frame, const Region& wall, const Region& field, const MountedCamera& camera,
                       const RayMap& rays, const BoundaryOptions& options = {});

}  // namespace tassilo
