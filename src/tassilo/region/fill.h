#pragma once

#include <cstdint>
#include <limits>

#include "tassilo/region/components.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// Pixels outside the region that are cut off from infinity by it: with 8-connected foreground the background is
/// 4-connected, and the other way round. An island inside a hole is no part of the hole. Empty if there is none.
/// O(R + rows of the bounding box).
Region holes(const Region& region, Connectivity foreground = Connectivity::eight);

/// Which holes `fill_holes` fills: those whose area is in [min_area_px, max_area_px].
struct FillOptions {
  std::int64_t min_area_px = 1;                                         ///< Smaller holes stay open. [px^2], >= 0
  std::int64_t max_area_px = std::numeric_limits<std::int64_t>::max();  ///< Larger holes stay open. [px^2], >= 0
  Connectivity foreground = Connectivity::eight;                        ///< The background has the dual one.
};

/// The region with its holes filled (HALCON `fill_up`; with areas `fill_up_shape` on 'area'; other features: `fill_up`
/// in select.h). Cost as `holes`.
Region fill_holes(const Region& region, const FillOptions& options = {});

}  // namespace tassilo
