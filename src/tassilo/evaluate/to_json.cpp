#include <nlohmann/json.hpp>

#include "tassilo/color/color_class.h"
#include "tassilo/evaluate/evaluate.h"
#include "tassilo/evaluate/internal/figures_json.h"

namespace tassilo {

using Json = nlohmann::ordered_json;

Json json_of(const std::optional<double>& value) { return value ? Json(*value + 0.0) : Json(nullptr); }  // 0 for -0

Json json_of(const Spread& s) {
  return {{"median", json_of(s.median)}, {"p90", json_of(s.p90)}, {"max", json_of(s.max)}, {"count", s.count}};
}

Json json_of(const std::map<std::string, StageTimes>& timing_ms) {
  Json out = Json::object();
  for (const auto& [stage, ms] : timing_ms)
    out[stage] = {{"median", json_of(ms.median)}, {"p99", json_of(ms.p99)}, {"max", json_of(ms.max)}};
  return out;
}

namespace {

using tassilo::json_of;  // not hidden by those below

Json json_of(const PoseScore& s) {
  return {{"share", json_of(s.share)},
          {"share_after_fix", json_of(s.share_after_fix)},
          {"position_m", json_of(s.position_m)},
          {"heading_deg", json_of(s.heading_deg)},
          {"good", json_of(s.good)},
          {"good_mirrored", json_of(s.good_mirrored)},
          {"good_after_fix", json_of(s.good_after_fix)},
          {"wrong", json_of(s.wrong)},
          {"mirror", json_of(s.mirror)},
          {"first_fix", json_of(s.first_fix)},
          {"never_fixed", s.never_fixed},
          {"nees_mean", json_of(s.nees_mean)},
          {"nees_median", json_of(s.nees_median)},
          {"bad_cov", s.bad_covariances}};
}

Json json_of(const BallScore& s) {
  return {{"recall_best", json_of(s.recall_best)},
          {"recall_any", json_of(s.recall_any)},
          {"frames", s.frames},
          {"precision_best", json_of(s.precision_best)},
          {"reported_best", s.reported_best},
          {"precision_all", json_of(s.precision_all)},
          {"reported", s.reported},
          {"error_m", json_of(s.error_m)},
          {"error_relative", json_of(s.error_relative)},
          {"bracketed", json_of(s.bracketed)},
          {"bracket_width_relative", json_of(s.bracket_width_relative)},
          {"nees_mean", json_of(s.nees_mean)}};
}

Json json_of(const GoalScore& s) {
  return {{"recall", json_of(s.recall)},
          {"frames", s.frames},
          {"precision", json_of(s.precision)},
          {"reported", s.reported},
          {"bearing_deg", json_of(s.bearing_deg)}};
}

Json json_of(const RobotScore& s) {
  return {{"recall", json_of(s.recall)},
          {"robots", s.robots},
          {"precision", json_of(s.precision)},
          {"reported", s.reported},
          {"team_right", json_of(s.team_right)},
          {"team_swapped", json_of(s.team_swapped)},
          {"to_nearest_m", json_of(s.to_nearest_m)},
          {"center_m", json_of(s.center_m)},
          {"bracketed", json_of(s.bracketed)},
          {"bracket_width_m", json_of(s.bracket_width_m)}};
}

Json json_of(const FreeSpaceScore& s) {
  return {{"sectors", s.sectors},
          {"blocked", s.blocked},
          {"error_m", json_of(s.error_m)},
          {"dangerous", json_of(s.dangerous)},
          {"timid", json_of(s.timid)},
          {"coverage", json_of(s.coverage)},
          {"state_free", json_of(s.state_free)},
          {"free_range_relative", json_of(s.free_range_relative)}};
}

Json json_of(const SequenceScore& s) {
  return {{"frames", s.frames},
          {"frames_missing", s.frames_missing},
          {"pose", json_of(s.pose)},
          {"ball", json_of(s.ball)},
          {"goals", {{"yellow", json_of(s.yellow)}, {"blue", json_of(s.blue)}, {"both", json_of(s.goals)}}},
          {"robots", json_of(s.robots)},
          {"free_space", json_of(s.free_space)},
          {"timing_ms", json_of(s.timing_ms)},
          {"notes", s.notes}};
}

Json json_of(const ColorScore& s) {
  Json classes = Json::object();
  for (std::size_t k = 0; k < s.classes.size(); ++k) {
    const ColorScore::Class& c = s.classes[k];
    classes[to_string(static_cast<ColorClass>(k))] = {
        {"pixels", c.pixels}, {"recall", json_of(c.recall)}, {"precision", json_of(c.precision)}};
  }
  return {{"maps", s.maps},
          {"missing", s.missing},
          {"accuracy", json_of(s.accuracy)},
          {"mean_recall", json_of(s.mean_recall)},
          {"mean_precision", json_of(s.mean_precision)},
          {"mean_over", s.mean_over},
          {"classes", classes},
          {"confusion", s.confusion}};
}

Json json_of(const BallImageScore& s) {
  Json missed = Json::array(), wrong = Json::array();
  for (const auto& place : s.missed) missed.push_back({{"image", place.image}, {"box", place.box}});
  for (const auto& place : s.wrong) wrong.push_back({{"image", place.image}, {"box", place.box}, {"best", place.best}});
  return {{"images", s.images},
          {"excluded", s.excluded},
          {"missing", s.missing},
          {"unknown", s.unknown},
          {"balls", s.balls},
          {"found", s.found},
          {"found_best", s.found_best},
          {"reported", s.reported},
          {"reported_best", s.reported_best},
          {"missed", missed},
          {"false", wrong},
          {"recall_best", json_of(s.recall_best)},
          {"recall_any", json_of(s.recall_any)},
          {"precision_best", json_of(s.precision_best)},
          {"precision_all", json_of(s.precision_all)}};
}

Json json_of(const PoseImageScore& s) {
  Json position = json_of(s.position_m), heading = json_of(s.heading_deg);
  for (Json* spread : {&position, &heading}) spread->erase("count");  // it is `poses`
  return {{"images", s.images},
          {"images_with_pose", s.images_with_pose},
          {"images_missing", s.images_missing},
          {"draws", s.draws},
          {"poses", s.poses},
          {"position_m", position},
          {"heading_deg", heading},
          {"wrong", json_of(s.wrong)}};
}

template <class Score>
Json json_of(const Named<Score>& named) {
  Json out = Json::object();
  for (const auto& [name, score] : named) out[name] = json_of(score);
  return out;
}

}  // namespace

Json json_of(const Evaluation& evaluation) {
  Json out = Json::object();
  if (evaluation.overall) {
    out["sequences"] = json_of(evaluation.sequences);
    out["overall"] = json_of(*evaluation.overall);
  }
  if (evaluation.colors)
    out["colors"] = {{"sets", json_of(evaluation.color_sets)}, {"overall", json_of(*evaluation.colors)}};
  if (evaluation.balls) out["balls"] = json_of(*evaluation.balls);
  if (!evaluation.poses.empty()) out["poses"] = json_of(evaluation.poses);
  return out;
}

std::string to_json(const Evaluation& evaluation) { return json_of(evaluation).dump(1) + "\n"; }

}  // namespace tassilo
