#include "tassilo/region/select.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "tassilo/base/sort_stably.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/fill.h"

namespace tassilo {
namespace {

/// The regions in the order of their keys, one each.
template <class Key>
RecycledVector<Region> sorted_by(std::span<const Region> regions, const RecycledVector<Key>& keys, SortOrder order) {
  RecycledVector<std::size_t> places(regions.size());
  for (std::size_t k = 0; k < places.size(); ++k) places[k] = k;
  sort_stably(places, [&](std::size_t a, std::size_t b) {
    return order == SortOrder::rising ? keys[a] < keys[b] : keys[b] < keys[a];
  });
  RecycledVector<Region> result;
  result.reserve(regions.size());
  for (const std::size_t place : places) result.push_back(regions[place]);
  return result;
}

}  // namespace

bool fits(const Region& region, std::span<const FeatureRange> ranges) {
  FeatureMeter meter(region);
  return std::ranges::all_of(ranges, [&](const FeatureRange& range) {
    const double value = meter(range.feature);
    return value >= range.min && value <= range.max;
  });
}

RecycledVector<Region> select(std::span<const Region> regions, std::span<const FeatureRange> ranges) {
  RecycledVector<Region> kept;
  for (const Region& region : regions)
    if (fits(region, ranges)) kept.push_back(region);
  return kept;
}

RecycledVector<Region> select(std::span<const Region> regions, std::initializer_list<FeatureRange> ranges) {
  return select(regions, std::span(ranges.begin(), ranges.size()));
}

RecycledVector<Region> sorted(std::span<const Region> regions, Feature feature, SortOrder order) {
  RecycledVector<double> keys;
  keys.reserve(regions.size());
  for (const Region& region : regions) keys.push_back(feature_value(region, feature));
  return sorted_by(regions, keys, order);
}

RecycledVector<Region> sorted_by_first_point(std::span<const Region> regions, SortOrder order) {
  RecycledVector<std::pair<int, int>> keys;
  keys.reserve(regions.size());
  for (const Region& region : regions) {
    constexpr int kBefore = -1 << 16;  // any row
    keys.push_back(region.empty() ? std::pair{kBefore, 0}
                                  : std::pair<int, int>{region.runs().front().row, region.runs().front().begin});
  }
  return sorted_by(regions, keys, order);
}

Region fill_up(const Region& region, std::span<const FeatureRange> ranges, Connectivity foreground) {
  const RecycledVector<Region> parts = components(holes(region, foreground), dual(foreground));
  return union_of(region, union_of(select(parts, ranges)));
}

}  // namespace tassilo
