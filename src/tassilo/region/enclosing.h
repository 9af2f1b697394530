#pragma once

#include "tassilo/geometry/point.h"
#include "tassilo/region/region.h"

namespace tassilo {

// Shapes around a region. As in features.h, pixels count as points at their centres: a single pixel is enclosed by a
// circle of radius 0, a box of w x h pixels by a rectangle of (w - 1) x (h - 1). The empty region has all 0. All are
// pure and safe from any thread.

/// A rectangle at any angle.
struct RotatedRectangle {
  PixelPoint center;                       ///< [px]
  double half_length = 0, half_width = 0;  ///< half_length >= half_width >= 0. [px]
  double phi = 0;                          ///< Direction of the length, as EquivalentEllipse has it: counter-clockwise
                                           ///< on the screen, in (-pi/2, pi/2]. [rad]
};
/// The rectangle of least area around all pixel centres; one of its sides lies on a side of the convex hull. HALCON
/// `smallest_rectangle2`; OpenCV `minAreaRect`. O(R).
/// source   Freeman, Shapira, "Determining the minimum-area encasing rectangle for an arbitrary closed curve", CACM
///          18(7), 1975; Toussaint, "Solving geometric problems with the rotating calipers", IEEE MELECON, 1983.
RotatedRectangle smallest_rectangle(const Region& region);

struct Circle {
  PixelPoint center;  ///< [px]
  double radius = 0;  ///< [px]
};
/// The smallest circle around all pixel centres; unique. HALCON `smallest_circle`; OpenCV `minEnclosingCircle`.
/// O(R), expected over the shuffle of the hull's corners, which is the same in every call.
/// source   Welzl, "Smallest enclosing disks (balls and ellipsoids)", LNCS 555, 1991.
Circle smallest_circle(const Region& region);

/// Pixels whose centres lie in the convex hull of the pixel centres or on it; its area is `convex_area`. HALCON
/// `shape_trans` 'convex'; OpenCV `convexHull` and `fillConvexPoly`. O(R + rows).
Region convex_region(const Region& region);

}  // namespace tassilo
