#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tassilo/base/kernel.h"
#include "tassilo/region/region.h"

namespace tassilo {

// Seen by skeleton.cpp, its test and its benchmark only.

using TileRow = std::uint64_t;  ///< 64 pixels; bit i is column i of the tile.
constexpr int kTileWidth = 64, kTileHeight = 8;

/// 64 x 8 pixels with the rows above and below, which belong to other tiles and are kept equal to theirs. A tile exists
/// where any of its ten rows has pixels, so a neighbor that does not exist is empty with the rows around it: index 0,
/// which is an empty tile.
struct ThinningTile {
  std::array<TileRow, kTileHeight + 2> rows{};
  std::int32_t left = 0, right = 0, above = 0, below = 0;
};

/// Some of a tile's own pixels.
using OwnRows = std::array<TileRow, kTileHeight>;

enum class ThinningStep {
  upper_right,  ///< Guo and Hall's first sub-iteration: pixels on the upper and the right border.
  lower_left,   ///< The second: those on the other borders.
  /// Pixels of a full 2 x 2 square that are simple. The paper's algorithm leaves some where lines meet. Each may go,
  /// but not all at once.
  square,
};

/// One way to find the pixels of a step; all give the same.
struct ThinningKernel {
  Kernel kernel;
  /// found[i] becomes the step's pixels of tile active[i].
  void (*find)(std::span<const ThinningTile> tiles, std::span<const std::int32_t> active, ThinningStep step,
               std::span<OwnRows> found);
};

/// Those of this build, of which the machine may not run all: the plain one first, the fastest last.
std::span<const ThinningKernel> thinning_kernels();

/// What a kernel finds for ThinningStep::square in own row k of one tile.
TileRow find_square(std::span<const ThinningTile> tiles, const ThinningTile& tile, std::size_t k);

/// `skeleton` with a kernel of choice, which this machine must support.
Region skeleton_by(const ThinningKernel& kernel, const Region& region);

}  // namespace tassilo
