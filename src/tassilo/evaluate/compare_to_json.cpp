#include <nlohmann/json.hpp>

#include "tassilo/evaluate/compare.h"
#include "tassilo/evaluate/internal/figures_json.h"

namespace tassilo {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Paired& p) { return {{"both", p.both}, {"only_a", p.only_a}, {"only_b", p.only_b}}; }

}  // namespace

std::string to_json(const Comparison& c) {
  Json differs = Json::object();
  for (const SubjectDifference& s : c.subjects) differs[s.subject] = s.frames;
  Json out;
  out["a"] = c.name_a;
  out["b"] = c.name_b;
  out["frames"] = {{"both", c.frames}, {"equal", c.equal_frames}, {"only_a", c.only_a}, {"only_b", c.only_b}};
  out["equal"] = c.equal();
  out["differs_in"] = differs;
  out["pose"] = {{"frames", json_of(c.pose.frames)},
                 {"distance_m", json_of(c.pose.distance_m)},
                 {"turn_deg", json_of(c.pose.turn_deg)},
                 {"kind_differs", c.pose.kind_differs},
                 {"mirror_differs", c.pose.mirror_differs}};
  out["balls"] = {{"balls", json_of(c.balls.balls)},
                  {"distance_m", json_of(c.balls.distance_m)},
                  {"center_px", json_of(c.balls.center_px)}};
  out["goals"] = {{"goals", json_of(c.goals.goals)},
                  {"bearing_deg", json_of(c.goals.bearing_deg)},
                  {"distance_m", json_of(c.goals.distance_m)}};
  out["robots"] = {{"robots", json_of(c.robots.robots)},
                   {"nearest_m", json_of(c.robots.nearest_m)},
                   {"center_m", json_of(c.robots.center_m)},
                   {"team_differs", c.robots.team_differs}};
  out["lines"] = {{"lines", json_of(c.lines.lines)},
                  {"circles", json_of(c.lines.circles)},
                  {"ends_px", json_of(c.lines.ends_px)},
                  {"center_m", json_of(c.lines.center_m)},
                  {"model_differs", c.lines.model_differs}};
  out["free_space"] = {{"frames", json_of(c.free_space.frames)},
                       {"other_sectors", c.free_space.other_sectors},
                       {"sectors", c.free_space.sectors},
                       {"state_differs", c.free_space.state_differs},
                       {"range_m", json_of(c.free_space.range_m)}};
  out["timing_ms"] = {{"a", json_of(c.timing_ms_a)}, {"b", json_of(c.timing_ms_b)}};
  if (c.truth_a && c.truth_b) out["truth"] = {{"a", json_of(*c.truth_a)}, {"b", json_of(*c.truth_b)}};
  return out.dump(1) + "\n";
}

}  // namespace tassilo
