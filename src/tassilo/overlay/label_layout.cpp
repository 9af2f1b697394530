#include "tassilo/overlay/internal/label_layout.h"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <utility>

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

double LabelLayout::harm(const Rect& place) const {
  constexpr double kTakenWeight = 50;  // a label that is read with difficulty is worse than a hidden box [1]
  double harm = 0;
  for (const Rect& area : taken_) harm += kTakenWeight * overlap(place, area);
  for (const Rect& area : clear_) harm += overlap(place, area);
  return harm;
}

Rect LabelLayout::place(const Rect& box, double width, double height) {
  constexpr double kGap = 3;        // between a label and what it stands beside [px]
  constexpr int kRings = 5;         // as many labels as crowd around one box in recordings [1]
  constexpr double kAway = 1 / 3.;  // of a label may hide boxes before it moves one ring away from its own [1]
  Rect best = moved_inside({box.x, box.y - height - kGap, width, height}, bounds_);
  double least = std::numeric_limits<double>::infinity();
  for (int ring = 0; ring < kRings; ++ring) {
    const double away = ring * kAway * width * height;
    if (away >= least) break;
    const double gap = kGap + ring * (height + kGap);
    const double left = box.x, right = box.right() - width, middle = box.x + (box.width - width) / 2;
    const double above = box.y - height - gap, below = box.bottom() + gap;
    const double beside_right = box.right() + gap, beside_left = box.x - width - gap;
    const double upper = box.y, lower = box.bottom() - height;
    for (const auto& [x, y] : std::initializer_list<std::pair<double, double>>{{left, above},
                                                                               {right, above},
                                                                               {middle, above},
                                                                               {left, below},
                                                                               {right, below},
                                                                               {middle, below},
                                                                               {beside_right, upper},
                                                                               {beside_left, upper},
                                                                               {beside_right, lower},
                                                                               {beside_left, lower}}) {
      const Rect place = moved_inside({x, y, width, height}, bounds_);
      const double cost = away + harm(place);
      if (cost >= least) continue;
      least = cost;
      best = place;
    }
  }
  taken_.push_back(best);
  return best;
}

}  // namespace tassilo
