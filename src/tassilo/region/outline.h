#pragma once

#include <span>

#include "tassilo/base/recycled.h"
#include "tassilo/geometry/point.h"
#include "tassilo/region/components.h"
#include "tassilo/region/region.h"

namespace tassilo {

// Between runs and closed polygons around them. All are pure and safe from any thread.

/// One closed polygon; the last corner is joined with the first. Seen on the screen, outer ones run clockwise, those of
/// holes counter-clockwise, so that the region is always on the right-hand side.
struct Outline {
  RecycledVector<PixelPoint> corners;  ///< [px]
  bool is_hole = false;
};

/// The outlines of a region along its pixels' edges: one around each component and one around each of its holes.
/// Corners lie between pixels, at half-numbered columns and rows, with a quarter turn at each. At a point where two
/// pixels touch by a corner only, an outline of 8-connected foreground goes on to the other pixel, one of 4-connected
/// foreground stays with its own. `region_from_outlines` gives the region back exactly.
///
/// returns  ordered by their topmost then leftmost edge, each beginning there; none for the empty region
/// cost     O(R), one allocation an outline. HALCON `gen_contour_region_xld` 'border_holes'.
/// source   own; each run's two ends are vertical edges, and rows that lie on each other say which edge follows which.
RecycledVector<Outline> outlines(const Region& region, Connectivity foreground = Connectivity::eight);

/// The outlines through the centres of the border pixels: corners are pixels of the region, sides lie along axes or
/// diagonals; a line one pixel wide is walked there and back, a single pixel is one corner. The outer ones together are
/// as long as `contour_length`. Number and order as `outlines` of 8-connected foreground. HALCON
/// `gen_contour_region_xld` 'center'; OpenCV `findContours` RETR_CCOMP with CHAIN_APPROX_SIMPLE. O(R).
RecycledVector<Outline> center_outlines(const Region& region);

/// Pixels of the window whose centres are inside an odd number of the polygons; rules and cost as
/// `region_from_polygon`. HALCON `gen_region_contour_xld` 'filled', then `symm_difference`; OpenCV `fillPoly` of
/// several.
Region region_from_outlines(std::span<const Outline> outlines, const PixelBox& window);

}  // namespace tassilo
