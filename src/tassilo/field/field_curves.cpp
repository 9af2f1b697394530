#include "tassilo/field/field_curves.h"

#include <numbers>
#include <utility>

namespace tassilo {
namespace {

/// The wall at x = `x`, but for the mouths of goals on that side.
void add_end_wall(std::vector<FieldLine>& lines, const FieldModel& field, GoalSide side, double x) {
  const std::string name = side == GoalSide::plus_x ? "x_plus" : "x_minus";
  double y = field.walls->y.low;
  for (const FieldModel::Goal& goal : field.goals) {
    if (goal.side != side) continue;
    lines.push_back({name, true, {x, y}, {x, -goal.width / 2}});
    y = goal.width / 2;
  }
  lines.push_back({name, true, {x, y}, {x, field.walls->y.high}});
}

}  // namespace

FieldExtent field_extent(const FieldModel& field) {
  if (field.walls) return {field.walls->x, field.walls->y};
  return {{-field.length / 2, field.length / 2}, {-field.width / 2, field.width / 2}};
}

FieldCurves field_curves(const FieldModel& field) {
  FieldCurves curves;
  std::vector<FieldLine>& lines = curves.lines;
  if (field.walls) {
    const auto& [x, y] = std::pair(field.walls->x, field.walls->y);
    add_end_wall(lines, field, GoalSide::plus_x, x.high);
    add_end_wall(lines, field, GoalSide::minus_x, x.low);
    lines.push_back({"y_plus", true, {x.low, y.high}, {x.high, y.high}});
    lines.push_back({"y_minus", true, {x.low, y.low}, {x.high, y.low}});
  }
  // Lengths are measured to the outer edges of lines, and lines are known by their middles.
  const double half_line = field.line_width / 2;
  const double x_end = field.length / 2 - half_line, y_side = field.width / 2 - half_line;
  if (field.touchlines) {
    lines.push_back({"x_plus", false, {x_end, -y_side}, {x_end, y_side}});
    lines.push_back({"x_minus", false, {-x_end, -y_side}, {-x_end, y_side}});
    lines.push_back({"y_plus", false, {-x_end, y_side}, {x_end, y_side}});
    lines.push_back({"y_minus", false, {-x_end, -y_side}, {x_end, -y_side}});
  }
  if (field.halfway_line) lines.push_back({"halfway", false, {0, -field.width / 2}, {0, field.width / 2}});
  for (std::size_t k = 0; k < field.areas.size(); ++k) {
    const auto& [depth, width] = field.areas[k];
    const std::string name = "area_" + std::to_string(k + 1);
    for (const double sign : {1., -1.}) {
      const double front = sign * (field.length / 2 - depth + half_line), end = sign * field.length / 2;
      const double side = width / 2 - half_line;
      lines.push_back({name + "_front", false, {front, -side}, {front, side}});
      lines.push_back({name + "_side", false, {front, side}, {end, side}});
      lines.push_back({name + "_side", false, {front, -side}, {end, -side}});
    }
  }
  for (std::size_t k = 0; k < field.segments.size(); ++k) {
    const FieldModel::Segment& s = field.segments[k];
    lines.push_back({"segment_" + std::to_string(k + 1), false, {s.x0, s.y0}, {s.x1, s.y1}});
  }
  if (field.circle_radius > 0)
    curves.arcs.push_back({"circle", {0, 0}, field.circle_radius, -std::numbers::pi, std::numbers::pi});
  for (std::size_t k = 0; k < field.arcs.size(); ++k) {
    const FieldModel::Arc& arc = field.arcs[k];
    curves.arcs.push_back({"arc_" + std::to_string(k + 1), {arc.cx, arc.cy}, arc.radius, arc.from, arc.to});
  }
  return curves;
}

}  // namespace tassilo
