#include "tassilo/app/field_json.h"

#include <nlohmann/json.hpp>
#include <string>

#include "tassilo/scene/scene.h"

namespace tassilo {

nlohmann::json field_json(const FieldModel& field) {
  using nlohmann::json;
  json areas = json::array(), goals = json::array();
  for (const FieldModel::Area& area : field.areas) areas.push_back({{"depth", area.depth}, {"width", area.width}});
  for (const FieldModel::Goal& goal : field.goals)
    goals.push_back({{"side", goal.side == GoalSide::plus_x ? "+x" : "-x"},
                     {"color", std::string(to_string(goal.color))},
                     {"width", goal.width},
                     {"depth", goal.depth}});
  return {{"length", field.length},
          {"width", field.width},
          {"circle_radius", field.circle_radius},
          {"halfway_line", field.halfway_line},
          {"areas", std::move(areas)},
          {"goals", std::move(goals)}};
}

}  // namespace tassilo
