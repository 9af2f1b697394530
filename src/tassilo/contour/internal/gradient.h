#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tassilo/base/kernel.h"

namespace tassilo {

// Seen by sub_pixel_edges.cpp and its test only.

/// Pixels are worked on in blocks of a row that begin at multiples of this.
constexpr int kBlock = 32;
/// The largest filter reaches this far from its centre. [px]
constexpr int kMaxReach = 3;

/// Gradients of a row by column; rows have whole blocks and one more block before the first.
struct GradientRow {
  std::int16_t *x = nullptr, *y = nullptr;  ///< To the right, downwards. [gradient_unit]
  std::int32_t* squared = nullptr;          ///< x^2 + y^2
};

/// What a gradient of one gray level per pixel becomes.
constexpr int gradient_unit(int reach) { return reach == 1 ? 8 : reach == 2 ? 128 : 256; }

/// Bytes of brightness around a row.
struct BrightnessRows {
  std::array<const std::uint8_t*, 2 * kMaxReach + 1> row{};  ///< [reach] is the row itself; column c is byte c * step.
  int step = 1;
  int width = 0;  ///< Beyond it, and left of 0, the border's value. [px]
};

/// One way to find gradients and their peaks; all give the same.
///
/// Filters are binomial: smoothing (1/4)^reach (1 1)^(2 reach), a Gaussian of sigma sqrt(reach / 2), across the
/// derivative (1 0 -1) (1 1)^(2 reach - 2).
struct GradientKernel {
  Kernel kernel;
  /// Gradients of the blocks at `columns`, of filters with `reach` 1 .. 3.
  void (*gradients)(const BrightnessRows& rows, int reach, std::span<const int> columns, const GradientRow& to);
  /// peaks[i] gets bit k when column columns[i] + k is a peak: not below `least` in the square, and a maximum of its
  /// row or, where the gradient is steeper downwards, of its column; of two equal ones the first.
  void (*peaks)(const std::array<GradientRow, 3>& above_here_below, std::int32_t least, std::span<const int> columns,
                std::span<std::uint32_t> peaks);
};

/// Those of this build, of which the machine may not run all: the plain one first, the fastest last.
std::span<const GradientKernel> gradient_kernels();

}  // namespace tassilo
