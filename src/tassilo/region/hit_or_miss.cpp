#include "tassilo/region/hit_or_miss.h"

#include "tassilo/region/algebra.h"
#include "tassilo/region/morphology.h"

namespace tassilo {

Region hit_or_miss(const Region& region, const Region& hit, const Region& miss) {
  Region places = erosion(region, hit);
  if (miss.empty() || places.empty()) return places;
  // p + m is in the region for some m exactly when p lies in the dilation with the reflected element.
  return difference(places, dilation(region, reflected(miss)));
}

}  // namespace tassilo
