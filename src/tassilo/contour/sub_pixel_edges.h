#pragma once

#include "tassilo/base/recycled.h"
#include "tassilo/contour/contour.h"
#include "tassilo/image/frame.h"
#include "tassilo/region/region.h"

namespace tassilo {

struct EdgeOptions {
  /// Of the derivative's mask: 3, 5 or 7. It acts as a Gaussian of sigma sqrt(size - 1) / 2, that is .7, 1 or 1.2
  /// pixels: larger ones see less noise and blur corners more.
  int filter_size_px = 5;
  /// An edge is followed where brightness changes at least by this. A step of height h in a sharp image gives about
  /// .38 h with filter 5 and .32 h with filter 7; noise of sigma n about .2 n and .15 n. [gray levels / px], > 0
  double low = 4;
  double high = 8;     ///< It must somewhere change by this, to be one. [gray levels / px], >= low
  int min_points = 5;  ///< Edges with fewer points are left out. >= 1
  void check() const;  ///< Throws Error naming the first field out of range.
};

/// Edges of the brightness Y inside a region as contours of sub-pixel points. HALCON `edges_sub_pix`; OpenCV has
/// `Canny`, which gives pixels.
///
/// Gradients by binomial filters; their maxima along the image axis that is closer to the gradient, placed between
/// pixels by a parabola through the neighbors on that axis; points linked to the nearest ones before and behind them
/// along the edge that have a similar direction; hysteresis by contour. Walking along a contour, the brighter side is
/// to the right as seen on the screen. Contours are ordered by their points in the order of rows and columns; no point
/// belongs to two.
///
/// frame    any format; brightness beyond its border is that of the border
/// region   pixels at which edges may be; those outside the frame or in its outermost rows and columns have none.
///          Gradients there are the same whatever the region is.
/// cost     O(pixels of the region and 1 around it, in blocks of 32 columns + R); memory: some rows and the edges'
/// points;
///          safe from any thread. Accuracy: see docs/regions.md.
/// source   J. Canny, "A computational approach to edge detection", IEEE PAMI 8(6), 1986; F. Devernay, "A non-maxima
///          suppression method for edge detection with sub-pixel accuracy", INRIA RR-2724, 1995, in the form of
///          R. Grompone von Gioi, G. Randall, "A sub-pixel edge detector", IPOL 7, 2017.
RecycledVector<Contour> sub_pixel_edges(const FrameView& frame, const Region& region, const EdgeOptions& options = {});

}  // namespace tassilo
