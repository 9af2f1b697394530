#pragma once

#include <cstdint>
#include <span>

#include "tassilo/base/kernel.h"
#include "tassilo/color/internal/kernel_table.h"
#include "tassilo/image/frame.h"

// To add a kernel: 1. its name in base/kernel.h and what it needs in kernel.cpp; 2. a source here with its
// functions (or those of a simpler one); 3. its place in `color_kernels`. The tests run every supported kernel against
// the definition. Others: region/internal/plane_kernel.h and thinning.h, contour/internal/gradient.h.

namespace tassilo {

/// Labels of a row and of those above and below it, `width` pixels each.
struct ThreeRows {
  const std::uint8_t *above, *here, *below;
};

/// Where the runs of a row go, those of equal labels but no_color, from left to right; each array has room for
/// width + 64 entries.
struct RowRuns {
  std::uint16_t *begin, *end;  ///< [px]
  std::uint8_t* label;
};

/// The inner loops of segmentation, one row at a time. All kernels give the same bytes.
struct ColorKernel {
  Kernel kernel;
  /// Claims of `pairs` chroma cells.
  void (*claims)(const KernelTable& table, const YuvRow& row, int pairs, std::uint8_t* claims);
  /// Labels 0..8 of `width` pixels from the claims of (width + 1) / 2 cells, and their runs unless `runs` is null.
  /// Returns how many runs.
  int (*labels)(const KernelTable& table, const std::uint8_t* claims, const YuvRow& row, int width,
                std::uint8_t* labels, const RowRuns* runs);
  /// Labels that all nine pixels around and at a place share, else no_color; beside the row is no_color.
  void (*erode)(const ThreeRows& rows, int width, std::uint8_t* labels);
  /// The label that any of the nine pixels has; those that are not no_color must be equal. And their runs, as `labels`.
  int (*dilate)(const ThreeRows& rows, int width, std::uint8_t* labels, const RowRuns& runs);
};

/// Those of this build, of which the machine may not run all: the plain one first, the fastest last.
std::span<const ColorKernel> color_kernels();

extern const ColorKernel plain_color_kernel;
#if defined(__x86_64__)
extern const ColorKernel avx2_color_kernel;
extern const ColorKernel avx512_color_kernel;
#elif defined(__aarch64__)
extern const ColorKernel neon_color_kernel;
#endif

}  // namespace tassilo
