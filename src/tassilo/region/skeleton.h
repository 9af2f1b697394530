#pragma once

#include "tassilo/region/region.h"

namespace tassilo {

/// The middle lines of a region, one pixel wide: what is left when border pixels are peeled off layer by layer, as long
/// as neither a part nor a hole appears or disappears and no end of a line gets shorter. HALCON `skeleton`; OpenCV
/// ximgproc `thinning` with THINNING_GUOHALL.
///
/// Laws: a subset of the region; as many 8-connected parts and as many holes as the region, each part within its part;
/// skeleton(skeleton(a)) = skeleton(a); lines one pixel wide stay as they are; a band of even width leaves one of its
/// two middle lines, the lower or the left one; moves with the region. Outside the region is background, so the border
/// of the image counts as any other border.
///
/// cost     O(R + P / 64) for R runs and P pixels, and for each layer as much as the tiles of 64 x 8 pixels that still
///          change; memory the same, whatever box the region spans. Safe from any thread.
/// source   Z. Guo, R. W. Hall, "Parallel thinning with two-subiteration algorithms", CACM 32(3), 1989, algorithm A1.
Region skeleton(const Region& region);

}  // namespace tassilo
