#pragma once

#include "tassilo/region/region.h"

namespace tassilo {

/// Places where a pattern fits: { p : p + h in region for all h in `hit`, p + m not in region for all m in `miss` }.
///
/// hit      must hold a pixel; miss may be empty, then this is the erosion with `hit`. Where they overlap nothing fits.
/// Outside the region is background, as in morphology.h. HALCON `hit_or_miss`; OpenCV `morphologyEx` MORPH_HITMISS with
/// 1 for hit and -1 for miss; Leptonica `pixHMT`.
/// cost     as `erosion` with hit and `dilation` with miss; pure, safe from any thread
/// source   Serra, "Image Analysis and Mathematical Morphology", 1982.
Region hit_or_miss(const Region& region, const Region& hit, const Region& miss);

}  // namespace tassilo
