#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tassilo/base/contract.h"
#include "tassilo/files/scene_json.h"

namespace tassilo {
namespace {

using Json = nlohmann::ordered_json;

void expect_finite(double value) { expects(std::isfinite(value), "the numbers of a scene are finite"); }

double rounded(double value, double steps) {
  expect_finite(value);
  const double scaled = value * steps;
  // Beyond 2^52 steps there is nothing left to round; + 0.0 makes -0 a plain 0.
  return (std::abs(scaled) < 4e15 ? std::round(scaled) / steps : value) + 0.0;
}
double metric(double value) { return rounded(value, 1e6); }
double pixel(double value) { return rounded(value, 1e3); }
double duration(double value) { return rounded(value, 1e4); }

/// Relative rounding: small variances must stay positive.
double variance(double value) {
  expect_finite(value);
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.8e", value);
  return std::strtod(text.data(), nullptr) + 0.0;
}

Json json_of(const PixelBox& box) { return {box.x0, box.y0, box.x1, box.y1}; }
Json json_of(const PixelPoint& p) { return {pixel(p.x), pixel(p.y)}; }
Json json_of(const FloorPoint& p) { return {metric(p.x), metric(p.y)}; }
Json json_of(const Eigen::Matrix2d& c) {
  return {variance(c(0, 0)), variance(c(0, 1)), variance(c(1, 0)), variance(c(1, 1))};
}

/// x, y, distance, bearing, near, far of a point on the floor; all null without one.
void add_floor_point(Json& out, const FloorPoint* point, const DistanceBounds& bounds) {
  for (const char* key : {"x", "y", "distance", "bearing", "near", "far"}) out[key] = nullptr;
  if (!point) return;
  const FloorPoint written{metric(point->x), metric(point->y)};  // so that a line that was read is written alike
  out["x"] = written.x;
  out["y"] = written.y;
  out["distance"] = metric(norm(written));
  out["bearing"] = metric(bearing(written));
  out["near"] = metric(bounds.near);
  const bool unbounded = std::isinf(bounds.far) && bounds.far > 0;
  if (!unbounded) out["far"] = metric(bounds.far);
}

template <std::size_t N>
Json json_of(const std::array<double, N>& covariance) {
  Json list = Json::array();
  for (const double value : covariance) list.push_back(variance(value));
  return list;
}

Json json_of(const std::optional<PoseSeen>& pose) {
  if (!pose) return nullptr;
  return {{"x", metric(pose->x)},          {"y", metric(pose->y)},
          {"theta", metric(pose->theta)},  {"cov", json_of(pose->covariance)},
          {"kind", to_string(pose->kind)}, {"age", metric(pose->age)},
          {"mirror", pose->mirror}};
}

Json json_of(const Ball& ball) {
  Json out;
  add_floor_point(out, ball.floor ? &ball.floor->position.mean : nullptr,
                  ball.floor ? ball.floor->bounds : DistanceBounds{});
  out["cov"] = ball.floor ? json_of(ball.floor->position.covariance) : Json();
  out["box"] = json_of(ball.box);
  out["center"] = json_of(ball.center);
  out["radius_px"] = pixel(ball.radius_px);
  out["confidence"] = rounded(ball.confidence, 1e4);
  return out;
}

Json json_of(const Goal& goal) {
  Json posts = Json::array();
  for (const GoalPost& post : goal.posts)
    posts.push_back({{"side", to_string(post.side)}, {"x", metric(post.position.x)}, {"y", metric(post.position.y)}});
  return {{"color", to_string(goal.color)},
          {"box", json_of(goal.box)},
          {"bearing", goal.bearing ? Json(metric(*goal.bearing)) : Json()},
          {"x", goal.position ? Json(metric(goal.position->x)) : Json()},
          {"y", goal.position ? Json(metric(goal.position->y)) : Json()},
          {"posts", posts}};
}

Json json_of(const RobotSeen& robot) {
  Json out;
  out["team"] = to_string(robot.team);
  add_floor_point(out, robot.floor ? &robot.floor->nearest.mean : nullptr,
                  robot.floor ? robot.floor->bounds : DistanceBounds{});
  out["center"] = robot.floor ? json_of(robot.floor->center) : Json();
  out["cov"] = robot.floor ? json_of(robot.floor->nearest.covariance) : Json();
  out["width"] = robot.floor ? Json(metric(robot.floor->width)) : Json();
  out["box"] = json_of(robot.box);
  return out;
}

Json json_of(const LineSeen& line) {
  return {{"kind", to_string(line.kind)},
          {"p", line.floor ? json_of(line.floor->first) : Json()},
          {"q", line.floor ? json_of(line.floor->second) : Json()},
          {"image", {json_of(line.image_p), json_of(line.image_q)}},
          {"model", line.model.empty() ? Json() : Json(line.model)}};
}

Json json_of(const CircleSeen& circle) {
  return {{"kind", "circle"}, {"center", json_of(circle.center)}, {"radius", metric(circle.radius)}};
}

Json json_of(const std::optional<FreeSpace>& space) {
  if (!space) return nullptr;
  expects(space->ranges.size() == space->states.size(), "free space has a state for each range");
  Json ranges = Json::array(), states = Json::array();
  for (std::size_t i = 0; i < space->ranges.size(); ++i) {
    const bool unseen = space->states[i] == SectorState::unseen;
    ranges.push_back(unseen ? Json() : Json(metric(space->ranges[i])));
    states.push_back(to_string(space->states[i]));
  }
  return {{"origin", json_of(space->origin)},
          {"angle_min", metric(space->angle_min)},
          {"angle_increment", rounded(space->angle_increment, 1e9)},  // times the number of sectors
          {"ranges", ranges},
          {"state", states}};
}

Json json_of(const TrackSeen& track) {
  return {{"id", track.id},
          {"kind", to_string(track.kind)},
          {"team", to_string(track.team)},
          {"x", metric(track.x)},
          {"y", metric(track.y)},
          {"vx", metric(track.vx)},
          {"vy", metric(track.vy)},
          {"cov", json_of(track.covariance)},
          {"age", metric(track.age)}};
}

template <class T>
Json list_of(const RecycledVector<T>& values) {
  Json list = Json::array();
  for (const T& value : values) list.push_back(json_of(value));
  return list;
}

Json lines_of(const Scene& scene) {
  Json lines = list_of(scene.lines);
  for (const CircleSeen& circle : scene.circles) lines.push_back(json_of(circle));
  return lines;
}

Json why_of(const Scene& scene) {
  Json why = Json::object();
  for (const auto& [subject, reason] : scene.why)
    why[subject] = (why.contains(subject) ? why[subject].get<std::string>() + "; " : "").append(reason);
  return why;
}

Json timing_of(const Scene& scene) {
  Json timing = Json::object();
  for (const StageTime& time : scene.timing) timing[time.stage] = duration(timing.value(time.stage, 0.0) + time.ms);
  expects(timing.contains("total"), "a scene has its total time");
  return timing;
}

}  // namespace

std::string to_json_line(const Scene& scene) {
  Json out;
  out["frame"] = scene.frame;
  out["t"] = metric(scene.t);
  if (!scene.image.empty()) out["image"] = scene.image;
  out["pose"] = json_of(scene.pose);
  out["balls"] = list_of(scene.balls);
  out["goals"] = list_of(scene.goals);
  out["robots"] = list_of(scene.robots);
  out["lines"] = lines_of(scene);
  out["free_space"] = json_of(scene.free_space);
  out["tracks"] = list_of(scene.tracks);
  out["why"] = why_of(scene);
  out["timing_ms"] = timing_of(scene);
  // A file name may be no UTF-8; a scene is not lost for that.
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace tassilo
