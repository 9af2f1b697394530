#pragma once

#include <vector>

namespace tassilo {

/// Axis-parallel rectangle in the picture. [px]
struct Rect {
  double x = 0, y = 0, width = 0, height = 0;

  double right() const { return x + width; }
  double bottom() const { return y + height; }
  friend bool operator==(const Rect&, const Rect&) = default;
};

/// Area in both. [px^2]
double overlap(const Rect& a, const Rect& b);

/// Finds places for labels beside their boxes: inside the picture, off each other and off what is kept free, and off
/// all boxes as far as there is room. Greedy, in the order of calls: the important ones first.
class LabelLayout {
 public:
  explicit LabelLayout(Rect bounds) : bounds_(bounds) {}

  /// Something labels hide only when all other places hide more: they move away from their boxes, rather.
  void keep_free(const Rect& area) { taken_.push_back(area); }
  /// Something labels should not hide, but may where they would have to move away from their boxes.
  void keep_clear(const Rect& area) { clear_.push_back(area); }

  /// Place for a label of this size beside `box`; the place is taken from then on. Always inside the bounds if it fits
  /// at all. O(what is taken).
  Rect place(const Rect& box, double width, double height);

 private:
  /// How bad it is to hide what lies there. [px^2]
  double harm(const Rect& place) const;

  Rect bounds_;
  std::vector<Rect> taken_;  ///< Kept free, and places of labels.
  std::vector<Rect> clear_;
};

}  // namespace tassilo
