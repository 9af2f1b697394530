#pragma once

#include <algorithm>
#include <cstdint>

namespace tassilo {

/// Axis-parallel box of pixels; ends are exclusive. [px]
struct PixelBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool empty() const { return x1 <= x0 || y1 <= y0; }
  std::int64_t area() const { return empty() ? 0 : std::int64_t{width()} * height(); }
  friend bool operator==(const PixelBox&, const PixelBox&) = default;
};

/// Pixels in both; possibly empty.
inline PixelBox intersection(const PixelBox& a, const PixelBox& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}
/// Smallest box around both; an empty box adds nothing.
inline PixelBox hull(const PixelBox& a, const PixelBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}
/// Area of the intersection over area of the union; 0 when either is empty.
inline double intersection_over_union(const PixelBox& a, const PixelBox& b) {
  const auto both = intersection(a, b).area();
  const auto either = a.area() + b.area() - both;
  return either > 0 ? static_cast<double>(both) / static_cast<double>(either) : 0.0;
}

}  // namespace tassilo
