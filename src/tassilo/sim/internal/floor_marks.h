#pragma once

#include <vector>

#include "tassilo/field/field_model.h"
#include "tassilo/geometry/point.h"

namespace tassilo {

/// White marks of a field's floor as a signed distance: how far a floor point is from the nearest edge of a mark,
/// negative within. Exact, and from a table of a quarter of a line's width, whose bilinear value is exact but where
/// edges meet.
class FloorMarks {
 public:
  explicit FloorMarks(const FieldModel& field);

  /// To the nearest edge. [m]
  double exact(FieldPoint at) const;

  struct Near {
    float distance = 1e3F;  ///< [m]
    float gx = 1, gy = 0;   ///< Its gradient, of length about 1 near edges.
    bool in_table = false;  ///< Else far from all marks.
  };
  Near near(float x, float y) const {
    const float column = (x - x0_) * per_cell_, row = (y - y0_) * per_cell_;
    if (!(column >= 0 && row >= 0 && column < columns_limit_ && row < rows_limit_)) return {};
    const int c = static_cast<int>(column), r = static_cast<int>(row);
    const float fx = column - static_cast<float>(c), fy = row - static_cast<float>(r);
    const float* cell = table_.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + c;
    const float a = cell[0], b = cell[1], d = cell[columns_], e = cell[columns_ + 1];
    const float low = a + fx * (b - a), high = d + fx * (e - d);
    return {low + fy * (high - low), ((b - a) * (1 - fy) + (e - d) * fy) * per_cell_, (high - low) * per_cell_, true};
  }

  float cell() const { return 1 / per_cell_; }  ///< [m]
  float line_width() const { return line_width_; }

 private:
  struct Strip {
    FieldPoint middle;
    double ux, uy, half_length, half_width;
  };
  struct Ring {
    FieldPoint center;
    double radius, from, sweep, half_width;
  };

  std::vector<Strip> strips_;
  std::vector<Ring> rings_;
  std::vector<float> table_;
  int columns_ = 0, rows_ = 0;
  float x0_ = 0, y0_ = 0, per_cell_ = 1, columns_limit_ = 0, rows_limit_ = 0, line_width_ = 0;
};

}  // namespace tassilo
