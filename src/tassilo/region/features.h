#pragma once

#include <cstdint>

#include "tassilo/base/recycled.h"
#include "tassilo/geometry/point.h"
#include "tassilo/region/components.h"
#include "tassilo/region/region.h"

namespace tassilo {

// Shape features of a whole region, connected or not. Definitions follow the HALCON operator reference (MVTec, chapter
// Regions / Features; the operator is named with each). Pixels count as points at their centres unless said otherwise,
// so a single pixel has radii 0 and a line one pixel wide has rb = 0. Every feature of the empty region is 0.
// All are pure and safe from any thread.

/// Central second moments over the area: mean products of the distances from the centre. [px^2]
/// HALCON `moments_region_2nd` divided by the area (M20 = rr, M11 = rc, M02 = cc);
/// OpenCV mu02 / m00, mu11 / m00, mu20 / m00.
struct SecondMoments {
  double rr = 0;  ///< row, row
  double rc = 0;  ///< row, column
  double cc = 0;  ///< column, column
};

/// The ellipse that has a region's second moments. HALCON `elliptic_axis`.
struct EquivalentEllipse {
  double ra = 0, rb = 0;  ///< Half axes, ra >= rb >= 0. [px]
  /// Direction of the long axis, as seen on the screen counter-clockwise from "right", in (-pi/2, pi/2]; 0 when the
  /// axes are equal. Rows grow downwards, so the axis points along (column, row) = (cos phi, -sin phi). [rad]
  double phi = 0;
};
/// That ellipse from the moments; where rb is but rounding noise it is 0. O(1).
EquivalentEllipse equivalent_ellipse(const SecondMoments& moments);

/// The features that one or two looks at each run give.
struct ShapeFeatures {
  std::int64_t area = 0;      ///< Number of pixels. HALCON `area_center`. [px^2]
  PixelPoint center;          ///< Mean of the pixel centres. HALCON `area_center`. [px]
  PixelBox box;               ///< Smallest axis-parallel box. HALCON `smallest_rectangle1`. [px]
  SecondMoments moments;      ///< [px^2]
  EquivalentEllipse ellipse;  ///< [px], [rad]
  /// ra / rb, 1 for a disc; 0 when rb = 0, as in HALCON: a perfect line is not "very long" but 0. HALCON
  /// `eccentricity`.
  double anisometry = 0;
  double bulkiness = 0;         ///< pi ra rb / area, 1 for an ellipse, larger with bulges. HALCON `eccentricity`.
  double structure_factor = 0;  ///< anisometry * bulkiness - 1; 0 when rb = 0. HALCON `eccentricity`.
  /// min(1, area / (pi d^2)), d the largest distance from the centre to a pixel; 1 for one pixel. HALCON `circularity`.
  double circularity = 0;
};
/// O(R), no allocation.
ShapeFeatures shape_features(const Region& region);

/// The direction a region points to: the ellipse's long axis, of its two ways the one on whose side the pixel farthest
/// from the centre lies, in (-pi, pi]; `ellipse.phi` for regions that are farthest on both sides. HALCON
/// `orientation_region`. O(R). [rad]
double orientation(const Region& region);

/// Length of the outer contours of all components, through the centres of the border pixels: 1 per step along an axis,
/// sqrt 2 per diagonal step; contours of holes do not count, those of islands in holes do; a line of n pixels is walked
/// both ways, 2 (n - 1). HALCON `contlength`; OpenCV `arcLength` over `findContours`. [px]
/// O(R a(R)), with one copy of each component.
/// source   own: counts of 2 x 2 pixel patterns after S. B. Gray, "Local properties of binary images in two
///          dimensions", IEEE Trans. Computers C-20(5), 1971.
double contour_length(const Region& region);
/// max(1, contour_length^2 / (4 pi area)): 1 for discs, larger for long or rough regions. HALCON `compactness`.
/// Cost as `contour_length`.
double compactness(const Region& region);

/// Number of components less number of holes. HALCON `euler_number`. O(R). source: Gray 1971, see above.
std::int64_t euler_number(const Region& region, Connectivity foreground = Connectivity::eight);
/// Number of holes, as `holes` defines them. HALCON `connect_and_holes`. O(R a(R)).
std::int64_t hole_count(const Region& region, Connectivity foreground = Connectivity::eight);

/// Corners of the convex hull of all pixel centres: the leftmost pixel of the top row first, then clockwise as seen on
/// the screen; no three on a line. One point for one pixel, two for a line, none for the empty region. [px]
/// O(R). source: A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions", IPL 9(5), 1979.
RecycledVector<PixelPoint> convex_hull(const Region& region);
/// Number of pixels whose centres lie in the convex hull or on it: the area of HALCON `shape_trans` 'convex'. O(R).
std::int64_t convex_area(const Region& region);
/// area / convex_area, in (0, 1]: 1 for a convex region. HALCON `convexity`. O(R).
double convexity(const Region& region);

/// How well the rectangle with the region's moments covers it: 1 - |rectangle xor region| / |rectangle|, cut at 0;
/// 1 for rectangles. After HALCON `rectangularity`, which leaves details open; here pixels are unit squares for the
/// moments, so that pixel boxes give exactly 1. O(R + height).
double rectangularity(const Region& region);

}  // namespace tassilo
