#pragma once

#include "tassilo/evaluate/internal/records.h"
#include "tassilo/geometry/point.h"

namespace tassilo {

constexpr double kMinOverlap = 0.2;  ///< Intersection over union of boxes that mean the same thing.

double intersection_over_union(const ScoreBox& a, const ScoreBox& b);
/// Middle of the pixels' centres. [px]
PixelPoint box_center(const ScoreBox& box);
bool contains(const ScoreBox& box, PixelPoint point);
/// Boxes overlap, or their centers are within 3 px, for balls of few pixels.
bool same_ball(const ScoreBox& a, const ScoreBox& b);

}  // namespace tassilo
