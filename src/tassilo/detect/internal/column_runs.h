#pragma once

#include "tassilo/base/recycled.h"
#include "tassilo/color/color_class.h"
#include "tassilo/region/region.h"

namespace tassilo {

/// One color of a robot along a column, from row `top` to row `foot`, both included.
struct ColumnRun {
  int column, top, foot;
  ColorClass color;
  friend bool operator==(const ColumnRun&, const ColumnRun&) = default;
};

/// Adds a region's runs along columns instead of rows, by rising foot. All of it lies in columns 0 .. width - 1. Only
/// where one row differs from the next something begins or ends, so that the cost is O(height + width + runs + pixels
/// of horizontal rims), not O(pixels).
void add_column_runs(const Region& region, ColorClass color, int width, RecycledVector<ColumnRun>& out);

}  // namespace tassilo
