#include "tassilo/contour/contour.h"

#include <cstddef>

namespace tassilo {

double length(const Contour& contour) {
  const auto& points = contour.points;
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += distance(points[i - 1], points[i]);
  return contour.closed && points.size() > 1 ? sum + distance(points.back(), points.front()) : sum;
}

}  // namespace tassilo
