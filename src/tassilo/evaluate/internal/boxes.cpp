#include "tassilo/evaluate/internal/boxes.h"

#include <algorithm>

namespace tassilo {

double intersection_over_union(const ScoreBox& a, const ScoreBox& b) {
  const double width = std::min(a[2], b[2]) - std::max(a[0], b[0]);
  const double height = std::min(a[3], b[3]) - std::max(a[1], b[1]);
  if (width <= 0 || height <= 0) return 0;
  const auto area = [](const ScoreBox& box) { return (box[2] - box[0]) * (box[3] - box[1]); };
  return width * height / (area(a) + area(b) - width * height);
}

PixelPoint box_center(const ScoreBox& box) { return {(box[0] + box[2] - 1) / 2, (box[1] + box[3] - 1) / 2}; }

bool contains(const ScoreBox& box, PixelPoint point) {
  return box[0] <= point.x && point.x < box[2] && box[1] <= point.y && point.y < box[3];
}

bool same_ball(const ScoreBox& a, const ScoreBox& b) {
  constexpr double near_px = 3;
  return intersection_over_union(a, b) >= kMinOverlap || distance(box_center(a), box_center(b)) <= near_px;
}

}  // namespace tassilo
