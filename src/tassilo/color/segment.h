#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "tassilo/color/color_table.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// One region per color class for one frame; the regions are disjoint, and what is in none is no_color.
struct Segmentation {
  int width = 0, height = 0;  ///< Of the frame. [px]
  std::array<Region, kColorClassCount> regions;
  std::vector<std::uint8_t> labels;  ///< 0..8 of every pixel, row-major.

  std::uint8_t label(int column, int row) const { return labels[static_cast<std::size_t>(row * width + column)]; }

  const Region& of(ColorClass color) const { return regions[static_cast<std::size_t>(class_index(color))]; }
};

struct KernelTable;

/// A color table made ready for whole frames. Immutable after construction; copies share it; safe from any thread.
/// Construction takes a look at every cell, some .1 ms.
class Classifier {
 public:
  explicit Classifier(const ColorTable& table);

  const ColorTable& table() const { return *table_; }
  ColorClass operator()(int y, int u, int v) const;
  /// For the inner loops only.
  const KernelTable& kernel_table() const { return *kernel_table_; }

 private:
  std::shared_ptr<const ColorTable> table_;
  std::shared_ptr<const KernelTable> kernel_table_;
};

/// Classifies every pixel and run-length encodes at once.
///
/// frame    any format, at most 32767 x 32767 pixels
/// recycled a former result whose memory is used again; in steady state nothing is allocated
/// cost     O(pixels + runs), about .1 ns a pixel and 5 ns a run with AVX-512; safe from any thread
/// source   DESIGN 6.2; equals `classify` pixel by pixel, whatever kernel is in use (base/kernel.h)
Segmentation segment(const FrameView& frame, const Classifier& classifier, Segmentation recycled = {});

/// The same with every region opened by a square of 3 x 3 pixels: single odd pixels become no_color.
///
/// Equals opening3x3(segment(frame, classifier)), but never makes the runs of what the opening takes away: about half
/// as long again as `segment`. Limits, `recycled`, threads and source as there.
Segmentation segment_opened(const FrameView& frame, const Classifier& classifier, Segmentation recycled = {});

/// Every region opened by a square of 3 x 3 pixels; what an opening takes away is no_color.
///
/// The regions are disjoint, so all are opened in one pass over the labels: about .05 ns a pixel with AVX-512. Equals
/// opening(region, rectangle(3, 3)) of each. `recycled` as for `segment`. Safe from any thread. source: own
Segmentation opening3x3(const Segmentation& segmentation, Segmentation recycled = {});

}  // namespace tassilo
