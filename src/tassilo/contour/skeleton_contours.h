#pragma once

#include "tassilo/base/recycled.h"
#include "tassilo/contour/contour.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// A stretch of a skeleton between two places where it ends or branches.
struct SkeletonContour {
  Contour contour;         ///< Through pixel centres; a contour that meets a junction has a pixel of it as end point.
  int from = -1, to = -1;  ///< Junctions at its first and last point; -1 where it ends freely, or is closed.
};

/// Neighboring pixels at which three or more stretches meet.
struct Junction {
  PixelPoint center;                  ///< Mean of its pixels. [px]
  RecycledVector<PixelPoint> pixels;  ///< At least one, in the order of rows and columns. [px]
};

struct SkeletonContours {
  RecycledVector<SkeletonContour>
      contours;  ///< Open ones by their first points in the order of rows and columns, then closed ones.
  RecycledVector<Junction> junctions;  ///< By their first pixels.
  RecycledVector<PixelPoint> ends;     ///< Pixels with one neighbor. [px]
};

struct SkeletonContourOptions {
  int min_points = 1;  ///< Contours with fewer are left out, junctions and ends stay. >= 1
  void check() const;  ///< Throws Error naming the first field out of range.
};

/// Takes a skeleton apart into contours. HALCON `gen_contours_skeleton_xld` and `junctions_skeleton`.
///
/// Two pixels are connected when they share an edge, or a corner and no neighbor that shares edges with both; so a
/// corner of a line is none of three. Pixels with three or more connections are junctions, those with one are ends.
/// Every pixel is in a junction or in exactly one contour, there once. A pixel alone is a contour of one point.
///
/// region   a `skeleton`; of a thick region nearly all is junction
/// cost     O(P) for P pixels; safe from any thread.
/// source   own; that adjacency is Rosenfeld's mixed (m-) adjacency
SkeletonContours skeleton_contours(const Region& skeleton, const SkeletonContourOptions& options = {});

/// Moves each point to the middle between the region's borders, along its row or its column, whichever is shorter.
///
/// Thinning ends on a pixel: in a band of even width it lies half a pixel to one side, always the same. Points outside
/// of the region, and those farther than `reach` from a border both ways, stay.
///
/// contour  points at pixel centres of the region, as its skeleton's contours have them
/// reach    [px], >= 1
/// cost     O(points x reach x log runs); safe from any thread. source: own
Contour centered(Contour contour, const Region& region, int reach);

}  // namespace tassilo
