#pragma once

#include "tassilo/region/components.h"
#include "tassilo/region/region.h"

namespace tassilo {

// Residues: what a morphological operator takes away or adds. Outside a region is background. All are pure, safe from
// any thread, and cost as the operator does.

/// Pixels of the region that have a neighbor outside it; with four neighbors the boundary is 8-connected and thin, with
/// eight it is 4-connected. Boundaries of holes count. HALCON `boundary` 'inner'; Leptonica `pixExtractBoundary`
/// type 1.
Region inner_boundary(const Region& region, Connectivity neighbors = Connectivity::four);
/// Pixels outside the region that have a neighbor in it. HALCON `boundary` 'outer'; Leptonica `pixExtractBoundary`
/// type 0.
Region outer_boundary(const Region& region, Connectivity neighbors = Connectivity::four);

/// What an opening takes away: difference(region, opening(region, element)). HALCON `top_hat`; OpenCV `morphologyEx`
/// MORPH_TOPHAT.
Region top_hat(const Region& region, const Region& element);
/// What a closing adds: difference(closing(region, element), region). HALCON `bottom_hat`; OpenCV `morphologyEx`
/// MORPH_BLACKHAT.
Region bottom_hat(const Region& region, const Region& element);

}  // namespace tassilo
