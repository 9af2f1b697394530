#pragma once

#include <span>

#include "tassilo/region/region.h"

namespace tassilo {

// Set algebra on regions. No operator clips: results may leave the image, as long as their coordinates stay within
// signed 16 bit; leaving that is a broken promise (`expects`), never a wrap. All are pure and safe from any thread.

/// A step on the pixel grid, columns to the right and rows downwards. [px]
struct PixelShift {
  int columns = 0, rows = 0;
};

/// Pixels in a or in b. O(Ra + Rb).
Region union_of(const Region& a, const Region& b);
/// Pixels in any of `regions`; empty for none. O(R log n) for n regions with R runs together.
Region union_of(std::span<const Region> regions);
/// Pixels in a and in b. O(Ra + Rb).
Region intersection(const Region& a, const Region& b);
/// Pixels in a, not in b. O(Ra + Rb).
Region difference(const Region& a, const Region& b);
/// Pixels in exactly one of a and b. O(Ra + Rb).
Region symmetric_difference(const Region& a, const Region& b);
/// Pixels of `domain` that are not in the region; what of the region lies outside the domain plays no part.
/// O(R + rows of the domain).
Region complement(const Region& region, const PixelBox& domain);

/// The region moved by `shift`. O(R).
Region translated(const Region& region, PixelShift shift);
/// Pixels of the region inside the box, which may be larger than 16 bit or empty. O(log R + runs in the box's rows).
Region clipped(const Region& region, const PixelBox& box);
/// Pixel (column, row) goes to (row, column). O(R + runs of the result).
Region transposed(const Region& region);
/// Pixel (column, row) goes to (-column, -row): the transposed element of morphology. O(R).
Region reflected(const Region& region);

}  // namespace tassilo
