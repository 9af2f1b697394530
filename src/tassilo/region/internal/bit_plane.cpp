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

std::size_t most_rows_of_band(const PlaneFrame& frame) { return std::max<std::size_t>(1, 4096 / frame.stride); }
/// Bands of rows that stay in the fastest cache, 4096 words or one row: calls use(first row, rows).
template <class Use>
void for_bands(const PlaneFrame& frame, Use use) {
  const std::size_t most = most_rows_of_band(frame);
  for (std::size_t first = 0; first < frame.rows; first += most) use(first, std::min(most, frame.rows - first));
}

/// Joins a plane with itself, shifted, over boxes of offsets; `sign` is the direction of the shifts.
template <class Join, class Triple, class Nine>
BitPlane over_boxes(BitPlane plane, const PlaneFrame& frame, std::span<const PixelBox> boxes, int sign, Join join,
                    Triple triple, Nine nine) {
  const PlaneKernel& kernel = version_in_use(plane_kernels());
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
  int height = 1;
  if (narrowest >= 3 && boxes[0].height() >= 3) {
    nine(kernel, spare.words(), tall.words(), words, frame.stride, sign);
    std::swap(tall, spare);
    grow(tall, 3, narrowest, 1, 0);
    height = 3;
  } else {
    grow(tall, 1, narrowest, 1, 0);
  }
  if (boxes.size() == 1 && boxes[0].x0 == 0 && boxes[0].y0 == 0) {
    grow(tall, height, boxes[0].height(), 0, 1);
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
  const PlaneKernel& kernel = version_in_use(plane_kernels());
  const auto runs = region.runs();
  auto run = runs.begin();
  for_bands(frame, [&](std::size_t first, std::size_t rows) {
    std::uint64_t* const words = plane.words() + first * frame.stride;
    std::fill_n(words, rows * frame.stride, 0);
    // Where the runs begin and end, then all between: the bit behind a row is none of its pixels.
    const auto turn = [&](std::size_t at) { words[at / kBits] ^= std::uint64_t{1} << at % kBits; };
    const int top = frame.y0 + static_cast<int>(first), bottom = top + static_cast<int>(rows);
    for (; run != runs.end() && run->row < bottom; ++run) {
      const std::size_t row = static_cast<std::size_t>(run->row - top) * frame.stride * kBits;
      turn(row + static_cast<std::size_t>(run->begin - frame.x0));
      turn(row + static_cast<std::size_t>(run->end - frame.x0));
    }
    kernel.fill(words, rows * frame.stride);
  });
  return plane;
}

Region region_of(const BitPlane& plane, const PlaneFrame& frame, PixelShift shift, std::size_t expected) {
  const PlaneKernel& kernel = version_in_use(plane_kernels());
  const std::size_t row_bits = frame.stride * kBits;
  RecycledBuffer<std::uint32_t> at(std::min(most_rows_of_band(frame), frame.rows) * row_bits + 16);
  RunVector runs;
  runs.reserve(expected);
  for_bands(frame, [&](std::size_t first, std::size_t rows) {
    const std::size_t changes = kernel.changes(at.data(), plane.words() + first * frame.stride, rows * frame.stride);
    // Each run changes the bits twice within its row, as the bit behind a row is 0.
    const std::size_t before = runs.size();
    runs.resize(before + changes / 2 + 8);
    kernel.runs(
        runs.data() + before, at.data(), changes,
        {frame.x0 + shift.columns, frame.y0 + shift.rows + static_cast<int>(first), static_cast<int>(row_bits)});
    runs.resize(before + changes / 2);
  });
  return Region::from_sorted(std::move(runs));
}

BitPlane dilated(BitPlane plane, const PlaneFrame& frame, std::span<const PixelBox> boxes) {
  return over_boxes(
      std::move(plane), frame, boxes, 1,
      [](const PlaneKernel& kernel, auto... arguments) { kernel.join_or(arguments...); },
      [](const PlaneKernel& kernel, auto... arguments) { kernel.triple_or(arguments...); },
      [](const PlaneKernel& kernel, auto... arguments) { kernel.nine_or(arguments...); });
}

BitPlane eroded(BitPlane plane, const PlaneFrame& frame, std::span<const PixelBox> boxes) {
  return over_boxes(
      std::move(plane), frame, boxes, -1,
      [](const PlaneKernel& kernel, auto... arguments) { kernel.join_and(arguments...); },
      [](const PlaneKernel& kernel, auto... arguments) { kernel.triple_and(arguments...); },
      [](const PlaneKernel& kernel, auto... arguments) { kernel.nine_and(arguments...); });
}

}  // namespace tassilo
