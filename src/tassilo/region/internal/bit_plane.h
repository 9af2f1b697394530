#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tassilo/base/recycled.h"
#include "tassilo/geometry/box.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// Where the pixels of a region lie in one string of bits: row after row of `stride` words, column x0 at the lowest bit
/// of a row's first word. Room to the right and below takes what a dilation adds; behind each row there is at least one
/// bit that no pixel uses.
struct PlaneFrame {
  int x0 = 0, y0 = 0;      ///< [px]
  std::size_t stride = 0;  ///< Of a row. [words]
  std::size_t rows = 0;    ///< [px]
  std::size_t guard = 0;   ///< Words of 0 before the first and behind the last row, for shifts that reach beyond.

  std::size_t words() const { return stride * rows; }
};
/// For regions within `box` that grow by up to `columns` and `rows` to the right and downwards and are shifted by as
/// much.
PlaneFrame plane_frame(const PixelBox& box, int columns, int rows);

/// A region as bits of a frame; words outside the rows are 0.
class BitPlane {
 public:
  /// Bits are not set yet; guards are.
  explicit BitPlane(const PlaneFrame& frame);

  std::uint64_t* words() { return words_.data() + guard_; }
  const std::uint64_t* words() const { return words_.data() + guard_; }

 private:
  std::size_t guard_;
  RecycledBuffer<std::uint64_t> words_;
};

/// The region's pixels, which must lie in the frame. O(words + runs).
BitPlane plane_of(const Region& region, const PlaneFrame& frame);
/// The region of the pixels that are set, moved by `shift`; `expected` runs or so. O(words + runs).
Region region_of(const BitPlane& plane, const PlaneFrame& frame, PixelShift shift, std::size_t expected);

/// Boxes whose union is a structuring element, moved so that the element's own box begins at pixel (0, 0); by rising
/// height, none empty.
BitPlane dilated(BitPlane plane, const PlaneFrame& frame, std::span<const PixelBox> boxes);
/// The same, for the erosion.
BitPlane eroded(BitPlane plane, const PlaneFrame& frame, std::span<const PixelBox> boxes);

}  // namespace tassilo
