#pragma once

#include "tassilo/region/region.h"

namespace tassilo {

// Binary morphology on regions. A structuring element is a region, too; its origin is pixel (0, 0).
// Outside a region is background, results are never clipped (a dilation may leave the image: `clipped` cuts it back),
// so all laws of set morphology hold exactly. Elements must not be empty; regions and elements must keep the element's
// width and height away from the limits of 16 bit coordinates. All are pure and safe from any thread.
//
// source   Serra, "Image Analysis and Mathematical Morphology", 1982. The element is taken apart into its maximal
//          boxes (own; a disc has one for each distinct half-width), of which each works on columns and rows apart
//          and grows by doubling: O(R (b + log h)) for b boxes and height h, R counting the runs in between.
//          A region with a run in every twelve words of 64 pixels of its box, or more, is worked on as bits of that
//          box: O(W (b + log h)) for W words, never more than O(R (b + log h)); docs/decisions/0009.

/// Centred box of width x height pixels, both >= 1; for even sizes the origin is right of and below the middle.
Region rectangle(int width, int height);
/// Pixels whose centre lies within `radius` of the origin; radius >= 0, so disc(0) is one pixel. [px]
Region disc(double radius);

/// {p + e : p in region, e in element}, the Minkowski sum. With point-symmetric elements HALCON `dilation1`, OpenCV
/// `dilate`; with others OpenCV's has the reflected element.
Region dilation(const Region& region, const Region& element);
/// {p : p + e in region for all e in element}. With point-symmetric elements HALCON `erosion1`; with any OpenCV
/// `erode`, border value 0.
Region erosion(const Region& region, const Region& element);
/// All places the element can reach inside the region: dilation(erosion(region)). Independent of the origin.
Region opening(const Region& region, const Region& element);
/// What the element cannot enter from outside: erosion(dilation(region)). Independent of the origin.
Region closing(const Region& region, const Region& element);

}  // namespace tassilo
