#include "tassilo/region/residue.h"

#include "tassilo/region/algebra.h"
#include "tassilo/region/elements.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

/// The origin and its neighbors.
Region neighborhood(Connectivity neighbors) { return neighbors == Connectivity::four ? diamond(1) : rectangle(3, 3); }

}  // namespace

Region inner_boundary(const Region& region, Connectivity neighbors) {
  return difference(region, erosion(region, neighborhood(neighbors)));
}

Region outer_boundary(const Region& region, Connectivity neighbors) {
  return difference(dilation(region, neighborhood(neighbors)), region);
}

Region top_hat(const Region& region, const Region& element) { return difference(region, opening(region, element)); }

Region bottom_hat(const Region& region, const Region& element) { return difference(closing(region, element), region); }

}  // namespace tassilo
