#pragma once

#include "tassilo/region/region.h"

namespace tassilo {

/// Which neighbors keep a pixel alive, by HALCON's names: 'n_4', the four that share an edge; 'n_8', the four that
/// share a corner only; 'n_48', all eight.
enum class NoiseNeighbors { n_4, n_8, n_48 };

/// Pixels of the region that have at least one of these neighbors in the region; so with n_48 exactly the single pixels
/// go. HALCON `remove_noise_region`; OpenCV `filter2D` of the mask and a comparison. O(R), pure, safe from any
/// thread.
Region remove_noise(const Region& region, NoiseNeighbors neighbors);

}  // namespace tassilo
