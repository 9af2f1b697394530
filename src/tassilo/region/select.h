#pragma once

#include <initializer_list>
#include <limits>
#include <span>

#include "tassilo/base/recycled.h"
#include "tassilo/region/components.h"
#include "tassilo/region/feature_table.h"
#include "tassilo/region/region.h"

namespace tassilo {

// Choosing and ordering regions by what they look like. All are pure and safe from any thread; costs are those of the
// features, see `feature_value`.

/// A feature must lie in [min, max], both inclusive.
struct FeatureRange {
  Feature feature = Feature::area;
  double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
};

/// Are all features in their ranges? True for no range. Features are computed in the order given, those after the first
/// one out of range not at all: put the cheap ones first.
bool fits(const Region& region, std::span<const FeatureRange> ranges);

/// The regions that fit, in their order: select(parts, {{Feature::area, 50, 1e9}, {Feature::circularity, .8, 1}}).
/// HALCON `select_shape` with 'and'; Leptonica `pixaSelectByAreaFraction` and the like.
RecycledVector<Region> select(std::span<const Region> regions, std::span<const FeatureRange> ranges);
RecycledVector<Region> select(std::span<const Region> regions, std::initializer_list<FeatureRange> ranges);

/// Which way `sorted` goes.
enum class SortOrder { rising, falling };

/// The regions ordered by a feature; equal ones keep their order. `Feature::row1` and the like sort by place, area by
/// size. HALCON `sort_region`; Leptonica `pixaSort`. O(n log n) and the features.
RecycledVector<Region> sorted(std::span<const Region> regions, Feature feature, SortOrder order = SortOrder::rising);
/// The regions ordered by their first pixels, top to bottom, then left to right; empty ones first. HALCON `sort_region`
/// 'first_point'. O(n log n).
RecycledVector<Region> sorted_by_first_point(std::span<const Region> regions, SortOrder order = SortOrder::rising);

/// The region with those of its holes filled that fit. HALCON `fill_up_shape`. Cost as `holes` and the features.
Region fill_up(const Region& region, std::span<const FeatureRange> ranges,
               Connectivity foreground = Connectivity::eight);

}  // namespace tassilo
