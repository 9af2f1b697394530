#include "tassilo/region/internal/bit_plane.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/region/internal/coordinate.h"
#include "tassilo/region/internal/plane_kernel.h"

namespace tassilo {
namespace {

constexpr std::size_t kBits = 64;

/// Bits [begin, end) of a row.
void set_bits(std::uint64_t* row, std::size_t begin, std::size_t end) {
  const std::size_t first = begin / kBits, last = (end - 1) / kBits;
  const std::uint64_t from = ~std::uint64_t{0} << begin % kBits;
  const std::uint64_t to = ~std::uint64_t{0} >> (kBits - 1 - (end - 1) % kBits);
  if (first == last) {
    row[first] |= from & to;
    return;
  }
  row[first] |= from;
  for (std::size_t i = first + 1; i < last; ++i) row[i] = ~std::uint64_t{0};
  row[last] |= to;
}

/// Joins a plane with itself, shifted, over boxes of offsets; `sign` is the direction of the shifts.
template <class Join, class Triple>
BitPlane over_boxes(BitPlane plane, const PlaneFrame& frame, std::span<const PixelBox> boxes, int sign, Join join,
                    Triple triple) {
  const PlaneKernel& kernel = plane_kernel(kernel_in_use());
  const std::size_t words = frame.words();
  const auto shift = [&](int columns, int rows) {
    return sign * (static_cast<std::ptrdiff_t>(columns) +
                   static_cast<std::ptrdiff_t>(rows) * static_cast<std::ptrdiff_t>(frame.stride * kBits));
  };
  BitPlane spare(frame);
  /// Over `count` places, each `columns` and `rows` from the one before, beginning with `have` places done already.
  const auto grow = [&](BitPlane& grown, int have, int count, int columns, int rows) {
    if (have == 1 && count >= 3) {
      triple(kernel, spare.words(), grown.words(), words, shift(columns, rows));
      std::swap(grown, spare);
      have = 3;
    }
    while (have < count) {
      const int step = std::min(have, count - have);
      join(kernel, spare.words(), grown.words(), grown.words(), words, shift(step * columns, step * rows));
      std::swap(grown, spare);
      have += step;
    }
  };
  // All boxes share the first `narrowest` columns; `tall` is the plane over those and rows 0 .. height - 1.
  const int narrowest = std::ranges::min(boxes, {}, &PixelBox::width).width();
  BitPlane tall = std::move(plane);
  grow(tall, 1, narrowest, 1, 0);
  int height = 1;
  if (boxes.size() == 1 && boxes[0].x0 == 0 && boxes[0].y0 == 0) {
    grow(tall, 1, boxes[0].height(), 0, 1);
    return tall;
  }
  BitPlane result(frame), wide(frame);
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const PixelBox& box = boxes[k];
    grow(tall, height, box.height(), 0, 1);
    height = box.height();
    const BitPlane* part = &tall;
    if (box.width() > narrowest) {
      // The first step leaves `tall` as it is.
      const int step = std::min(narrowest, box.width() - narrowest);
      join(kernel, wide.words(), tall.words(), tall.words(), words, shift(step, 0));
      grow(wide, narrowest + step, box.width(), 1, 0);
      part = &wide;
    }
    if (k == 0) {
      kernel.move(result.words(), part->words(), words, shift(box.x0, box.y0));
    } else {
      join(kernel, spare.words(), result.words(), part->words(), words, shift(box.x0, box.y0));
      std::swap(result, spare);
    }
  }
  return result;
}

}  // namespace

PlaneFrame plane_frame(const PixelBox& box, int columns, int rows) {
  PlaneFrame frame;
  frame.x0 = box.x0;
  frame.y0 = box.y0;
  frame.stride = static_cast<std::size_t>(box.width() + columns) / kBits + 1;
  frame.rows = static_cast<std::size_t>(box.height() + rows);
  frame.guard = frame.stride * static_cast<std::size_t>(rows) + static_cast<std::size_t>(columns) / kBits + 2;
  return frame;
}

BitPlane::BitPlane(const PlaneFrame& frame) : guard_(frame.guard), words_(frame.words() + 2 * frame.guard) {
  std::fill_n(words_.data(), guard_, 0);
  std::fill_n(words_.data() + guard_ + frame.words(), guard_, 0);
}

BitPlane plane_of(const Region& region, const PlaneFrame& frame) {
  BitPlane plane(frame);
  std::uint64_t* const words = plane.words();
  std::fill_n(words, frame.words(), 0);
  for (const PixelRun& run : region.runs())
    set_bits(words + static_cast<std::size_t>(run.row - frame.y0) * frame.stride,
             static_cast<std::size_t>(run.begin - frame.x0), static_cast<std::size_t>(run.end - frame.x0));
  return plane;
}

Region region_of(const BitPlane& plane, const PlaneFrame& frame, PixelShift shift, std::size_t expected) {
  // Bands of rows, so that what a kernel may write stays small beside the plane.
  constexpr std::size_t band_words = 4096;
  const PlaneKernel& kernel = plane_kernel(kernel_in_use());
  const std::size_t band_rows = std::max<std::size_t>(1, band_words / frame.stride);
  const std::size_t row_bits = frame.stride * kBits;
  RecycledBuffer<std::uint32_t> at(std::min(band_rows, frame.rows) * row_bits + 2);
  RunVector runs;
  runs.reserve(expected);
  const double rows_per_bit = 1 / static_cast<double>(row_bits);
  for (std::size_t first = 0; first < frame.rows; first += band_rows) {
    const std::size_t band = std::min(band_rows, frame.rows - first);
    const std::size_t changes = kernel.changes(at.data(), plane.words() + first * frame.stride, band * frame.stride);
    // Each run changes the bits twice within its row, as the bit behind a row is 0.
    const std::size_t before = runs.size();
    runs.resize(before + changes / 2);
    const int left = frame.x0 + shift.columns, top = frame.y0 + shift.rows + static_cast<int>(first);
    for (std::size_t k = 0; k < changes; k += 2) {
      // Exact: the number of a bit has 32 bits, a double 53, and a bit's middle lies half a bit from the next row.
      const int row = static_cast<int>((at[k] + 0.5) * rows_per_bit);
      const int begin_of_row = row * static_cast<int>(row_bits);
      runs[before + k / 2] = {to_coordinate(top + row), to_coordinate(left + static_cast<int>(at[k]) - begin_of_row),
                              to_coordinate(left + static_cast<int>(at[k + 1]) - begin_of_row)};
    }
  }
  return Region::from_sorted(std::move(runs));
}

BitPlane dilated(BitPlane plane, const PlaneFrame& frame, std::span<const PixelBox> boxes) {
  return over_boxes(
      std::move(plane), frame, boxes, 1,
      [](const PlaneKernel& kernel, auto... arguments) { kernel.join_or(arguments...); },
      [](const PlaneKernel& kernel, auto... arguments) { kernel.triple_or(arguments...); });
}

BitPlane eroded(BitPlane plane, const PlaneFrame& frame, std::span<const PixelBox> boxes) {
  return over_boxes(
      std::move(plane), frame, boxes, -1,
      [](const PlaneKernel& kernel, auto... arguments) { kernel.join_and(arguments...); },
      [](const PlaneKernel& kernel, auto... arguments) { kernel.triple_and(arguments...); });
}

}  // namespace tassilo
