#include "tassilo/region/roundness.h"

#include <algorithm>
#include <cmath>

#include "tassilo/region/features.h"
#include "tassilo/region/residue.h"

namespace tassilo {

Roundness roundness(const Region& region) {
  if (region.empty()) return {};
  const PixelPoint center = shape_features(region).center;
  const Region boundary = inner_boundary(region);
  double sum = 0, sum_of_squares = 0;
  for (const PixelRun& run : boundary.runs())
    for (int c = run.begin; c < run.end; ++c) {
      const PixelPoint from = PixelPoint{static_cast<double>(c), static_cast<double>(run.row)} - center;
      sum += norm(from);
      sum_of_squares += dot(from, from);
    }
  const double n = static_cast<double>(area(boundary));
  Roundness result;
  result.distance = sum / n;
  // Less than rounding leaves over is none.
  const double variance = sum_of_squares / n - result.distance * result.distance;
  result.deviation = variance > 1e-12 * result.distance * result.distance ? std::sqrt(variance) : 0;
  if (result.distance > 0) result.roundness = std::max(0.0, 1 - result.deviation / result.distance);
  if (result.deviation > 0) result.sides = 1.4111 * std::pow(result.distance / result.deviation, .4724);
  return result;
}

}  // namespace tassilo
