#include "tassilo/region/remove_noise.h"

#include "tassilo/base/contract.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

Region element_of(NoiseNeighbors neighbors) {
  switch (neighbors) {
    case NoiseNeighbors::n_4:
      return Region::from_sorted({{-1, 0, 1}, {0, -1, 0}, {0, 1, 2}, {1, 0, 1}});
    case NoiseNeighbors::n_8:
      return Region::from_sorted({{-1, -1, 0}, {-1, 1, 2}, {1, -1, 0}, {1, 1, 2}});
    case NoiseNeighbors::n_48:
      return Region::from_sorted({{-1, -1, 2}, {0, -1, 0}, {0, 1, 2}, {1, -1, 2}});
  }
  broken_promise("known noise neighbors");
}

}  // namespace

Region remove_noise(const Region& region, NoiseNeighbors neighbors) {
  return intersection(region, dilation(region, element_of(neighbors)));
}

}  // namespace tassilo
