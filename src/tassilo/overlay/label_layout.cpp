#include "tassilo/overlay/internal/label_layout.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tassilo {
namespace {

double overlap_1d(double a0, double a1, double b0, double b1) {
  return std::max(0.0, std::min(a1, b1) - std::max(a0, b0));
}

Rect moved_inside(Rect rect, const Rect& bounds) {
  rect.x = std::max(bounds.x, std::min(rect.x, bounds.right() - rect.width));
  rect.y = std::max(bounds.y, std::min(rect.y, bounds.bottom() - rect.height));
  return rect;
}

}  // namespace

double overlap(const Rect& a, const Rect& b) {
  return overlap_1d(a.x, a.right(), b.x, b.right()) * overlap_1d(a.y, a.bottom(), b.y, b.bottom());
}

Rect LabelLayout::place(const Rect& box, double width, double height) {
  constexpr double kGap = 3;
  const double left = box.x, right = box.right() - width, middle = box.x + (box.width - width) / 2;
  const double above = box.y - height - kGap, below = box.bottom() + kGap;
  const double beside_right = box.right() + kGap, beside_left = box.x - width - kGap;
  const std::array<Rect, 9> candidates{{{left, above, width, height},
                                        {right, above, width, height},
                                        {middle, above, width, height},
                                        {left, below, width, height},
                                        {right, below, width, height},
                                        {beside_right, box.y, width, height},
                                        {beside_left, box.y, width, height},
                                        {beside_right, box.bottom() - height, width, height},
                                        {beside_left, box.bottom() - height, width, height}}};
  Rect best = moved_inside(candidates[0], bounds_);
  double least = std::numeric_limits<double>::infinity();
  for (const Rect& candidate : candidates) {
    const Rect place = moved_inside(candidate, bounds_);
    double hidden = 0;
    for (const Rect& area : taken_) hidden += overlap(place, area);
    if (hidden >= least) continue;
    least = hidden;
    best = place;
  }
  taken_.push_back(best);
  return best;
}

}  // namespace tassilo
