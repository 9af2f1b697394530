#include "tassilo/app/calibration_requests.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/files/json.h"

namespace tassilo {
namespace {

using nlohmann::json;

constexpr std::string_view kPath = "/api/calibration";
constexpr std::array kModels{LensModel::division, LensModel::plumb_bob, LensModel::equidistant};

json points_json(const TargetView& view) {
  json points = json::array();
  for (const SeenPoint& point : view.points) points.push_back({point.pixel.x, point.pixel.y});
  return points;
}

json look_json(const CalibrationSession::Look& look) {
  return {{"frame", look.frame},
          {"target", look.view ? json(to_text(look.view->target)) : json(nullptr)},
          {"points", look.view ? points_json(*look.view) : json::array()},
          {"verdict", look.verdict},
          {"is_captured", look.is_captured}};
}

/// `result`: of the view, null before.
json view_json(const CalibrationSession::View& view, const ViewResult* result) {
  return {{"id", view.id},
          {"frame", view.frame},
          {"target", to_text(view.view.target)},
          {"points", points_json(view.view)},
          {"rms_px", result != nullptr && result->rms_px > 0 ? json(result->rms_px) : json(nullptr)},
          {"rejected", result != nullptr ? result->rejected : ""}};
}

json result_json(const Intrinsics& result) {
  json values = json::array();
  for (const EstimatedValue& value : result.values)
    values.push_back({{"name", value.name}, {"value", value.value}, {"sigma", value.sigma}});
  return {
      {"model", distortion_name(result.camera.distortion)},
      {"views", std::ranges::count_if(result.views, [](const ViewResult& view) { return view.rejected.empty(); })},
      {"rms_px", result.rms_px},
      {"cross_validated_rms_px", result.cross_validated_rms_px ? json(*result.cross_validated_rms_px) : json(nullptr)},
      // 0 stands for a camera of which no direction could be followed.
      {"worst_sigma_px", std::isfinite(result.worst_sigma_px) ? json(result.worst_sigma_px) : json(nullptr)},
      {"values", std::move(values)},
      {"warnings", result.warnings}};
}

WebResponse state_response(const CalibrationSession& session) {
  const CalibrationSession::State state = session.state();
  json targets = json::array(), views = json::array();
  for (const Target& target : state.targets) targets.push_back(to_text(target));
  for (std::size_t i = 0; i < state.views.size(); ++i)
    views.push_back(view_json(state.views[i], state.result ? &state.result->views[i] : nullptr));
  const json all{{"is_on", state.is_on},
                 {"is_automatic", state.is_automatic},
                 {"is_solving", state.is_solving},
                 {"targets", std::move(targets)},
                 {"model", to_string(state.model)},
                 {"width", state.size.width},
                 {"height", state.size.height},
                 {"now", state.now ? look_json(*state.now) : json(nullptr)},
                 {"views", std::move(views)},
                 {"coverage",
                  {{"columns", state.coverage.columns},
                   {"rows", state.coverage.rows},
                   {"points", state.coverage.points},
                   {"share", state.coverage.share}}},
                 {"result", state.result ? result_json(*state.result) : json(nullptr)},
                 {"failure", state.failure},
                 {"file", {{"camera", state.file.string()}, {"refusal", state.refusal}, {"is_saved", state.is_saved}}}};
  return {200, "application/json", all.dump(-1, ' ', false, json::error_handler_t::replace)};
}

CalibrationSession::Change change_of(const std::string& body) {
  constexpr std::size_t longest_target = 64;
  const Map map = parse_json(body, "request").map({"is_on", "targets", "model", "is_automatic"});
  CalibrationSession::Change change;
  if (const auto is_on = map.find("is_on")) change.is_on = is_on->boolean();
  if (const auto is_automatic = map.find("is_automatic")) change.is_automatic = is_automatic->boolean();
  if (const auto model = map.find("model")) {
    std::vector<std::string_view> names;
    for (const LensModel one : kModels) names.push_back(to_string(one));
    change.model = kModels[model->choice(names)];
  }
  if (const auto targets = map.find("targets")) {
    change.targets.emplace();
    for (const Value& target : targets->list(1, CalibrationSession::kMostTargets)) {
      const std::string name = target.string();
      if (name.size() > longest_target)
        target.fail("has " + std::to_string(name.size()) + " letters, must have at most " +
                    std::to_string(longest_target));
      change.targets->push_back(target_from_text(name));
    }
  }
  return change;
}

WebResponse answer_view(CalibrationSession& session, const std::string& method, const std::string& id) {
  if (method != "DELETE") return refusal(405, "a view is forgotten by DELETE");
  return session.forget(id) ? state_response(session) : refusal(404, "there is no such view");
}

WebResponse answer_views(CalibrationSession& session, const std::string& method) {
  if (method == "POST")
    session.capture_next();
  else if (method == "DELETE")
    session.forget_all();
  else
    return refusal(405, "a view is captured by POST, all are forgotten by DELETE");
  return state_response(session);
}

}  // namespace

WebResponse answer_calibration(CalibrationSession& session, const WebRequest& request,
                               const std::function<void()>& take_over) {
  const std::string what = request.path.substr(kPath.size());
  constexpr std::string_view views = "/views/";
  const bool reads = request.method == "GET" || request.method == "HEAD";
  session.watched();
  try {
    if (what.empty()) {
      if (request.method == "PUT") {
        try {
          session.change(change_of(request.body));
        } catch (const Error& error) {
          return refusal(400, error.what());
        }
      } else if (!reads) {
        return refusal(405, "calibration is read by GET and changed by PUT");
      }
      return state_response(session);
    }
    if (what.starts_with(views)) return answer_view(session, request.method, what.substr(views.size()));
    if (what == "/views") return answer_views(session, request.method);
    if (what == "/residuals") {
      if (!reads) return refusal(405, "must be read by GET");
      const auto picture = session.residuals();
      return picture ? WebResponse{200, "image/png", encode_png(*picture)} : refusal(404, "there is no result");
    }
    if (what == "/solve" || what == "/save") {
      if (request.method != "POST") return refusal(405, "must be asked by POST");
      if (what == "/solve")
        session.solve();
      else
        session.save(take_over);
      return state_response(session);
    }
    return refusal(404, "there is nothing at " + request.path);
  } catch (const Error& error) {
    return refusal(409, error.what());
  }
}

}  // namespace tassilo
