#pragma once

#include "tassilo/region/region.h"

namespace tassilo {

// Regions mirrored and scaled. Nothing is clipped; coordinates that leave signed 16 bit are a broken promise
// (`expects`). All are pure and safe from any thread. Steps and quarter turns are in algebra.h.

/// Pixel (column, row) goes to (2 about - column, row). `about` is a pixel's column or halfway between two, so a
/// multiple of .5; about = (width - 1) / 2. mirrors an image of that width in place. HALCON `mirror_region` 'column'.
/// O(R).
Region mirrored_left_right(const Region& region, double about);
/// Pixel (column, row) goes to (column, 2 about - row), `about` as above. HALCON `mirror_region` 'row'. O(R).
Region mirrored_top_bottom(const Region& region, double about);

/// How many times wider and higher something becomes; both > 0 and finite.
struct ZoomFactors {
  double columns = 1, rows = 1;
};

/// The region drawn larger or smaller: pixel (column, row) of the result is inside where the pixel is that holds its
/// centre scaled back, (floor((column + .5) / columns), floor((row + .5) / rows)). So pixels are unit squares, the
/// outer corner (-.5, -.5) of the image's first pixel stays, and whole factors repeat each pixel that many times.
/// Shrinking drops what lies between the centres, up to everything. HALCON `zoom_region`; OpenCV `resize` with
/// INTER_NEAREST_EXACT. O(R + runs of the result).
Region zoomed(const Region& region, ZoomFactors factors);

}  // namespace tassilo
