#include "tassilo/app/field_json.h"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "tassilo/scene/scene.h"

namespace tassilo {

nlohmann::json field_json(const FieldModel& field) {
  using nlohmann::json;
  const auto interval = [](const Interval& i) { return json::array({i.low, i.high}); };
  json areas = json::array(), segments = json::array(), arcs = json::array(), goals = json::array();
  for (const FieldModel::Area& area : field.areas) areas.push_back({{"depth", area.depth}, {"width", area.width}});
  for (const FieldModel::Segment& s : field.segments) segments.push_back(json::array({s.x0, s.y0, s.x1, s.y1}));
  for (const FieldModel::Arc& arc : field.arcs)
    arcs.push_back(json::array({arc.cx, arc.cy, arc.radius, arc.from, arc.to}));
  for (const FieldModel::Goal& goal : field.goals)
    goals.push_back({{"side", goal.side == GoalSide::plus_x ? "+x" : "-x"},
                     {"color", std::string(to_string(goal.color))},
                     {"width", goal.width},
                     {"depth", goal.depth}});
  json walls;
  if (field.walls) walls = {{"x", interval(field.walls->x)}, {"y", interval(field.walls->y)}};
  return {{"length", field.length},
          {"width", field.width},
          {"circle_radius", field.circle_radius},
          {"halfway_line", field.halfway_line},
          {"areas", std::move(areas)},
          {"segments", std::move(segments)},
          {"arcs", std::move(arcs)},
          {"goals", std::move(goals)},
          {"walls", std::move(walls)},
          {"ball", {{"radius", interval(field.ball.radius)}}},
          {"robots", {{"width", interval(field.robots.width)}}}};
}

}  // namespace tassilo
