#pragma once

#include <array>
#include <memory>
#include <span>
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

/// A color table made ready for whole frames: 256 brightness sets and the winner of every set of claims.
///
/// Immutable after construction; safe from any thread.
class Classifier {
 public:
  explicit Classifier(const ColorTable& table);

  const ColorTable& table() const { return *table_; }
  ColorClass operator()(int y, int u, int v) const {
    return static_cast<ColorClass>(winner_[table_->cell(u, v) & bright_[static_cast<std::size_t>(y)]]);
  }
  /// Labels 0..8 of one row of `labels.size()` pixels.
  void row(const YuvRow& row, std::span<std::uint8_t> labels) const;

 private:
  std::shared_ptr<const ColorTable> table_;
  std::array<ClassBits, 256> bright_{};     ///< Classes whose interval holds Y.
  std::array<std::uint8_t, 256> winner_{};  ///< Label of a set of claims.
};

/// Classifies every pixel and run-length encodes at once.
///
/// frame    any format, at most 32767 x 32767 pixels
/// recycled a former result whose memory is used again; in steady state nothing is allocated
/// cost     O(pixels + runs); safe from any thread
/// source   DESIGN 6.2; equals `classify` pixel by pixel
Segmentation segment(const FrameView& frame, const Classifier& classifier, Segmentation recycled = {});

}  // namespace tassilo
