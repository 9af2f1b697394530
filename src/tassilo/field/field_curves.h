#pragma once

#include <string>
#include <vector>

#include "tassilo/field/field_model.h"
#include "tassilo/geometry/point.h"

namespace tassilo {

/// A straight mark of the field: the foot of a wall's inner face, or the middle of a line.
struct FieldLine {
  std::string name;  ///< x_plus, x_minus, y_plus, y_minus, halfway, area_.., segment_..; walls and lines alike.
  bool is_wall = false;
  FieldPoint p, q;
};
/// A round one: the centre circle, or an arc.
struct FieldArc {
  std::string name;  ///< circle, arc_..
  FieldPoint center;
  double radius = 0;        ///< To the line's middle. [m]
  double from = 0, to = 0;  ///< Counter-clockwise; a whole turn for a circle. [rad]
};

/// All that a field's lines and walls show from above.
struct FieldCurves {
  std::vector<FieldLine> lines;
  std::vector<FieldArc> arcs;
};

/// What bounds a field: the inner faces of its walls, else the outer edges of its lines. [m]
struct FieldExtent {
  Interval x, y;
};
FieldExtent field_extent(const FieldModel& field);

/// Marks of a field. Walls have gaps where goals are; lines are given by their middles.
FieldCurves field_curves(const FieldModel& field);

}  // namespace tassilo
