#pragma once

#include "tassilo/base/recycled.h"
#include "tassilo/detect/view.h"
#include "tassilo/scene/line_mark.h"
#include "tassilo/scene/scene.h"

namespace tassilo {

struct LineOptions {
  double tolerance_px = 1.5;  ///< A point this far from a line still lies on it. [px], > 0
  int min_points = 12;        ///< Rows or columns that show a line. >= 3
  double min_length = 0.3;    ///< Shorter pieces are dropped. [m], > 0
  double max_gap = 0.4;       ///< Longer gaps end a line; the ball or a robot may hide a piece. [m], > 0
  int max_lines = 12;         ///< >= 1
  double min_arc = 1.0;       ///< Of the centre circle in view. [rad], > 0
  void check() const;         ///< Throws Error naming the first field out of range.
};

struct Lines {
  RecycledVector<LineSeen> lines;      ///< Longest on the floor first within each kind, boundary before line.
  RecycledVector<CircleSeen> circles;  ///< At most one.
  RecycledVector<LineMark> marks;  ///< Places of both to sub-pixel accuracy, a few tens each; `line` counts `lines`.
};

/// Field lines, the field's boundary where carpet meets a wall, and the centre circle; nothing without calibration.
///
/// Middles of narrow white stretches, and places where carpet ends below a wall, are grouped by what is straight for
/// the lens: rays in one plane. The circle is looked for first, with the field's radius.
///
/// cost     O(pixels + points x trials), some .1 ms; deterministic; safe from any thread
/// source   Fischler, Bolles, "Random sample consensus", CACM 24(6), 1981, on great circles (own)
Lines find_lines(const View& view, const LineOptions& options = {});

}  // namespace tassilo
