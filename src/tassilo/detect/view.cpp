#include "tassilo/detect/view.h"

#include <algorithm>
#include <cmath>

namespace tassilo {

double longest_distance(const FieldModel& field) {
  double length = field.length, width = field.width;
  if (field.walls) {
    length = std::max(length, field.walls->x.high - field.walls->x.low);
    width = std::max(width, field.walls->y.high - field.walls->y.low);
  }
  double depth = 0;
  for (const auto& goal : field.goals) depth = std::max(depth, goal.depth);
  return std::hypot(length + 2 * depth, width);
}

}  // namespace tassilo
