#pragma once

#include "tassilo/base/recycled.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// About how large the parts of `partition_into_rectangles` are, both >= 1. [px]
struct PartSize {
  int width = 1, height = 1;
};

/// The region cut along a grid. Its bounding box, W x H, is divided into max(1, round(W / width)) columns and
/// max(1, round(H / height)) rows of cells that differ by at most one pixel; a part is what of the region lies in a
/// cell. Parts that would be empty are left out; the others come row of cells by row of cells, disjoint, their union
/// the region. A part need not be connected. None for the empty region. HALCON `partition_rectangle`. O(R + pieces of
/// runs + cells), one allocation a part.
RecycledVector<Region> partition_into_rectangles(const Region& region, PartSize size);

}  // namespace tassilo
