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

/// Finds places for labels beside their boxes: inside the picture, off all boxes and off each other as far as there is
/// room. Greedy, in the order of calls: the important ones first.
class LabelLayout {
 public:
  explicit LabelLayout(Rect bounds) : bounds_(bounds) {}

  /// Something labels should not hide.
  void keep_clear(const Rect& area) { taken_.push_back(area); }

  /// Place for a label of this size beside `box`; the place is taken from then on. Always inside the bounds if it fits
  /// at all. O(what is taken).
  Rect place(const Rect& box, double width, double height);

 private:
  Rect bounds_;
  std::vector<Rect> taken_;
};

}  // namespace tassilo
