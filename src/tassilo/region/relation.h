#pragma once

#include <cstdint>

#include "tassilo/region/region.h"

namespace tassilo {

// How two regions lie to each other, without making a third. Equality is `==`. No allocation, pure, safe
// from any thread. O(log R + runs in the rows that both have); where an area enters, O(R).

/// Number of pixels in both: area(intersection(a, b)).
std::int64_t common_area(const Region& a, const Region& b);
/// Is there a pixel in both? Stops at the first.
bool overlaps(const Region& a, const Region& b);
/// Is every pixel of `inner` in `outer`? True for the empty region. HALCON `test_subset_region`.
bool is_subset(const Region& inner, const Region& outer);
/// Number of pixels in exactly one: area(symmetric_difference(a, b)). HALCON `hamming_distance`.
std::int64_t hamming_distance(const Region& a, const Region& b);
/// Pixels in both over pixels in any, 0 to 1 (Jaccard index); 0 where both are empty.
double intersection_over_union(const Region& a, const Region& b);

}  // namespace tassilo
