#pragma once

#include "tassilo/geometry/point.h"
#include "tassilo/region/region.h"

namespace tassilo {

// How long a region is in one direction or another. Pixels count as points at their centres, so a single pixel has
// diameter 0 and a line of n pixels n - 1; whoever measures over pixel edges adds about 1. All 0 for the empty region.
// All are pure, safe from any thread, and cost O(R).
//
// source   Shamos, "Computational Geometry", PhD thesis, Yale, 1978 (antipodal pairs of a convex polygon).

/// Two pixels of a region that are as far apart as any, and their distance. [px]
struct Diameter {
  PixelPoint first, second;  ///< `first` comes first in the region's order.
  double length = 0;
};
/// Of several pairs the same one in every call. HALCON `diameter_region`, which takes pixels of the contour; the same
/// ones.
Diameter diameter(const Region& region);

/// A caliper's opening and how it is turned: `angle` is the direction measured along, counter-clockwise on the screen
/// from "right", in (-pi/2, pi/2]. [px], [rad]
struct CaliperWidth {
  double length = 0;
  double angle = 0;
};
/// Largest and smallest extent over all directions; the largest equals `diameter`, the smallest is measured across a
/// side of the convex hull. HALCON `region_features` 'max_diameter' for the largest.
struct FeretDiameters {
  CaliperWidth max, min;
};
FeretDiameters feret_diameters(const Region& region);

/// Extent along a direction: the largest less the smallest projection of a pixel's centre. `angle` as above, any. [px]
double feret_diameter(const Region& region, double angle);

}  // namespace tassilo
