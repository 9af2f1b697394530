#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tassilo/geometry/point.h"
#include "tassilo/region/region.h"

namespace tassilo {

// Between regions and what is made of pixels or corners. All are pure and safe from any thread.

/// A borrowed look at one byte per pixel, rows from top to bottom; passed by value, never outlives the bytes.
struct ByteView {
  const std::uint8_t* data = nullptr;
  int width = 0, height = 0;  ///< [px]
  std::ptrdiff_t stride = 0;  ///< From row to row. [bytes]

  std::span<const std::uint8_t> row(int r) const { return {data + r * stride, static_cast<std::size_t>(width)}; }
};

/// Pixels whose byte is in the set. O(pixels).
Region region_of_bytes(ByteView image, const std::bitset<256>& values);
/// Pixels whose byte b fulfills keep(b), which is asked once for each of the 256 values:
/// region_where(mask, [](int b) { return b != 0; }).
template <class Keep>
Region region_where(ByteView image, Keep keep) {
  std::bitset<256> values;
  for (int value = 0; value < 256; ++value) values[static_cast<std::size_t>(value)] = keep(value);
  return region_of_bytes(image, values);
}

/// One region a label: [k] holds the pixels with label k, for k < count; larger labels are in none. One pass,
/// O(pixels).
std::vector<Region> regions_of_labels(ByteView labels, int count);

/// The window's pixels, row by row without gaps: `inside` where the region is, else 0. What of the region lies outside
/// the window is cut. O(area of the window).
std::vector<std::uint8_t> to_mask(const Region& region, const PixelBox& window, std::uint8_t inside = 255);

/// The window's pixels, row by row without gaps: k where regions[k] is, else 0; where regions overlap, the last one
/// wins. At most 256 regions. Undoes `regions_of_labels`. O(area of the window + runs).
std::vector<std::uint8_t> to_labels(std::span<const Region> regions, const PixelBox& window);

/// Pixels of the window whose centres are inside the closed polygon, by the even-odd rule; it may cross itself.
///
/// A centre exactly on the outline belongs to the polygon when the inside is to its right or, on a horizontal edge,
/// below it. So polygons that share an edge share no pixel and leave no gap. Fewer than three corners: empty.
/// vertices finite, may lie anywhere [px]; window within 16 bit
/// cost     O(E + N log N) for E edges and N crossings of edges with rows of the window.
/// source   own; the scan-line rule is that of common graphics interfaces (top-left rule).
Region region_from_polygon(std::span<const PixelPoint> vertices, const PixelBox& window);

/// Pixels of the window whose centres are at most `radius` from the open line through `way`, as a round brush paints
/// it. One point: a disc; none: empty.
/// way      finite, may lie anywhere [px]; radius >= 0 [px]; window within 16 bit
/// cost     O(rows touched by each segment), own
Region region_from_stroke(std::span<const PixelPoint> way, double radius, const PixelBox& window);

}  // namespace tassilo
