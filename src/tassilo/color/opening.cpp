#include <array>
#include <cstddef>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/color/internal/color_kernel.h"
#include "tassilo/color/internal/run_sinks.h"
#include "tassilo/color/segment.h"

namespace tassilo {

// Labels stay labels: the erosion keeps one where nine neighbors share it. In the opening a pixel belongs to a square
// of equal labels, two squares of different ones have no pixel in common, so the dilation meets one label and no_color
// only.
Segmentation opening3x3(const Segmentation& segmentation, Segmentation recycled) {
  const auto width = static_cast<std::size_t>(segmentation.width);
  const int height = segmentation.height;
  expects(segmentation.labels.size() == width * static_cast<std::size_t>(height), "one label a pixel");
  const ColorKernel& kernel = color_kernel(kernel_in_use());
  recycled.width = segmentation.width;
  recycled.height = height;
  recycled.labels.resize(segmentation.labels.size());
  RunSinks sinks(recycled);

  const RecycledVector<std::uint8_t> outside(width);
  std::array<RecycledVector<std::uint8_t>, 3> eroded;  // rows r - 1, r and r + 1, at their number modulo 3
  eroded.fill(outside);
  const auto labels_of = [&](int r) {
    return r < 0 || r >= height ? outside.data() : segmentation.labels.data() + static_cast<std::size_t>(r) * width;
  };
  const auto eroded_row = [&](int r) -> RecycledVector<std::uint8_t>& {
    return eroded[static_cast<std::size_t>((r + 3) % 3)];
  };
  for (int r = 0; r < height; ++r) {
    // Of the first and the last row nothing is left: what lies outside is background.
    if (r + 1 < height - 1)
      kernel.erode({labels_of(r), labels_of(r + 1), labels_of(r + 2)}, segmentation.width, eroded_row(r + 1).data());
    else
      eroded_row(r + 1) = outside;
    std::uint8_t* labels = recycled.labels.data() + static_cast<std::size_t>(r) * width;
    kernel.dilate({eroded_row(r - 1).data(), eroded_row(r).data(), eroded_row(r + 1).data()}, segmentation.width,
                  labels);
    sinks.add_row(kernel, r, labels);
  }
  std::move(sinks).finish(recycled);
  return recycled;
}

}  // namespace tassilo
