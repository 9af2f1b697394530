#pragma once

#include "tassilo/region/region.h"

namespace tassilo {

/// How round a region is, seen from its centre of gravity; HALCON `roundness`. All 0 for the empty region.
struct Roundness {
  double distance = 0;   ///< Mean distance of the boundary's pixels from the centre. [px]
  double deviation = 0;  ///< Root mean squared difference from that mean. [px]
  double roundness = 0;  ///< 1 - deviation / distance: 1 for a circle; 0 for distance 0.
  /// 1.4111 (distance / deviation)^0.4724: the number of sides if the region is a regular polygon; 0 for deviation 0.
  double sides = 0;
};
/// Of the pixels of `inner_boundary(region)`, those of holes included. Pure, safe from any thread.
/// cost     O(R + pixels of the boundary)
/// source   Haralick, "A measure for circularity of digital figures", IEEE Trans. SMC 4, 1974; HALCON's formula.
Roundness roundness(const Region& region);

}  // namespace tassilo
