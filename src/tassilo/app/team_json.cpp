#include "tassilo/app/team_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tassilo {
namespace {

using nlohmann::json;

/// A browser draws nothing smaller than that.
double rounded(double value, double steps) { return std::round(value * steps) / steps + 0.0; }
json meters(double value) { return std::isfinite(value) ? json(rounded(value, 1e4)) : json(); }
json seconds(double value) { return std::isfinite(value) ? json(rounded(value, 1e3)) : json(); }
template <class T>
json or_null(const std::optional<T>& value) {
  return value ? seconds(*value) : json();
}
/// Six significant digits.
json variance(double value) {
  if (value == 0 || !std::isfinite(value)) return 0;
  const double steps = std::pow(10, 5 - std::floor(std::log10(std::abs(value))));
  return rounded(value, steps);
}

json json_of(FloorPoint point) { return {meters(point.x), meters(point.y)}; }
json json_of(const Eigen::Matrix2d& c) {
  return {variance(c(0, 0)), variance(c(0, 1)), variance(c(1, 0)), variance(c(1, 1))};
}
template <std::size_t n>
json json_of(const std::array<double, n>& covariance) {
  json list = json::array();
  for (const double value : covariance) list.push_back(variance(value));
  return list;
}

json json_of(const PoseSeen& pose) {
  return {{"x", meters(pose.x)},          {"y", meters(pose.y)},
          {"theta", meters(pose.theta)},  {"cov", json_of(pose.covariance)},
          {"kind", to_string(pose.kind)}, {"age", seconds(pose.age)},
          {"mirror", pose.mirror}};
}

void add_place(json& out, FloorPoint point, const DistanceBounds& bounds) {
  out["x"] = meters(point.x);
  out["y"] = meters(point.y);
  out["distance"] = meters(norm(point));
  out["bearing"] = meters(bearing(point));
  out["near"] = meters(bounds.near);
  out["far"] = meters(bounds.far);
}

json json_of(const Ball& ball) {
  json out;
  add_place(out, ball.floor->position.mean, ball.floor->bounds);
  out["cov"] = json_of(ball.floor->position.covariance);
  out["confidence"] = meters(ball.confidence);
  return out;
}

json json_of(const Goal& goal) {
  json posts = json::array();
  for (const GoalPost& post : goal.posts)
    posts.push_back({{"side", to_string(post.side)}, {"x", meters(post.position.x)}, {"y", meters(post.position.y)}});
  return {{"color", to_string(goal.color)},
          {"bearing", goal.bearing ? meters(*goal.bearing) : json()},
          {"x", goal.position ? meters(goal.position->x) : json()},
          {"y", goal.position ? meters(goal.position->y) : json()},
          {"posts", std::move(posts)}};
}

json json_of(const RobotSeen& robot) {
  json out;
  add_place(out, robot.floor->nearest.mean, robot.floor->bounds);
  out["team"] = to_string(robot.team);
  out["center"] = json_of(robot.floor->center);
  out["cov"] = json_of(robot.floor->nearest.covariance);
  out["width"] = meters(robot.floor->width);
  return out;
}

json json_of(const LineSeen& line) {
  return {{"kind", to_string(line.kind)},
          {"p", json_of(line.floor->first)},
          {"q", json_of(line.floor->second)},
          {"model", line.model.empty() ? json() : json(line.model)}};
}

json json_of(const CircleSeen& circle) {
  return {{"kind", "circle"}, {"center", json_of(circle.center)}, {"radius", meters(circle.radius)}};
}

json json_of(const FreeSpace& space) {
  json ranges = json::array(), states = json::array();
  for (std::size_t i = 0; i < space.ranges.size(); ++i) {
    ranges.push_back(space.states[i] == SectorState::unseen ? json() : meters(space.ranges[i]));
    states.push_back(to_string(space.states[i]));
  }
  return {{"origin", json_of(space.origin)},
          {"angle_min", space.angle_min},
          {"angle_increment", space.angle_increment},
          {"ranges", std::move(ranges)},
          {"state", std::move(states)}};
}

json json_of(const TrackSeen& track) {
  return {{"id", track.id},
          {"kind", to_string(track.kind)},
          {"team", to_string(track.team)},
          {"x", meters(track.x)},
          {"y", meters(track.y)},
          {"vx", meters(track.vx)},
          {"vy", meters(track.vy)},
          {"cov", json_of(track.covariance)},
          {"age", seconds(track.age)}};
}

json json_of(const TeamThing& thing) {
  json covariance = json::array();  // symmetric: its order is row-major as well
  for (const double value : thing.covariance.reshaped()) covariance.push_back(variance(value));
  json robots = json::array();
  for (const int robot : thing.robots) robots.push_back(robot);
  return {{"x", meters(thing.position.mean.x)},
          {"y", meters(thing.position.mean.y)},
          {"vx", meters(thing.vx)},
          {"vy", meters(thing.vy)},
          {"cov", std::move(covariance)},
          {"age", seconds(thing.age)},
          {"robots", std::move(robots)}};
}

json json_of(const TeamOpponent& opponent) {
  json out = json_of(static_cast<const TeamThing&>(opponent));
  out["id"] = opponent.id;
  out["team"] = to_string(opponent.team);
  return out;
}

template <class List>
json list_of(const List& values) {
  json list = json::array();
  for (const auto& value : values) list.push_back(json_of(value));
  return list;
}

/// With the keys of schema/scene.schema.json, without what is of the image.
json scene_json(const Scene& scene) {
  json lines = list_of(scene.lines);
  for (const CircleSeen& circle : scene.circles) lines.push_back(json_of(circle));
  return {{"pose", scene.pose ? json_of(*scene.pose) : json()},
          {"balls", list_of(scene.balls)},
          {"goals", list_of(scene.goals)},
          {"robots", list_of(scene.robots)},
          {"lines", std::move(lines)},
          {"free_space", scene.free_space ? json_of(*scene.free_space) : json()},
          {"tracks", list_of(scene.tracks)}};
}

json json_of(const TeamMember& member, bool has_picture) {
  return {{"id", member.id},
          {"team", to_string(member.team)},
          {"presence", to_string(member.presence)},
          {"age", seconds(member.age)},
          {"has_picture", has_picture},
          {"scene", scene_json(member.scene)},
          {"pose_kind", member.pose_kind ? json(to_string(*member.pose_kind)) : json("none")},
          {"pose_age", or_null(member.pose_age)},
          {"role", member.role},
          {"action", member.action},
          {"planning_state", member.planning_state},
          {"frame_rate", seconds(member.frame_rate)},
          {"latency", meters(member.latency)},
          {"message_age", or_null(member.message_age)},
          {"messages_per_second", seconds(member.messages_per_second)},
          {"bytes_per_second", std::round(member.bytes_per_second)},
          {"loss", or_null(member.loss)},
          {"refused", member.refused},
          {"withheld", member.withheld},
          {"clock_offset", or_null(member.clock_ahead)},
          {"troubles", member.troubles}};
}

/// Text of others has been looked at, but a page must not fail for one byte.
std::string dumped(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

}  // namespace

std::string team_picture_json(const TeamPicture& picture, const TeamWorld& world, std::int64_t news,
                              std::span<const int> with_pictures) {
  json robots = json::array();
  for (const TeamMember& member : picture.members)
    robots.push_back(json_of(member, std::ranges::binary_search(with_pictures, member.id)));
  json out{{"t", seconds(picture.t)},
           {"robots", std::move(robots)},
           {"opponents", list_of(world.opponents)},
           {"troubles", picture.troubles},
           {"news", news},
           {"counts",
            {{"heard", picture.counts.heard},
             {"refused", picture.counts.refused},
             {"late", picture.counts.late},
             {"repeated", picture.counts.repeated},
             {"bytes_per_second", std::round(picture.counts.bytes_per_second)}}}};
  if (world.ball) out["team_ball"] = json_of(static_cast<const TeamThing&>(*world.ball));
  return dumped(out);
}

std::string team_news_json(std::span<const TeamNews> news) {
  json list = json::array();
  for (const TeamNews& one : news)
    list.push_back({{"number", one.number},
                    {"t", seconds(one.t)},
                    {"robot", one.robot >= 0 ? json(one.robot) : json()},
                    {"text", one.text}});
  return dumped(list);
}

std::string team_trails_json(std::span<const TeamTrail> trails) {
  json robots = json::array();
  for (const TeamTrail& trail : trails) {
    json points = json::array();
    for (const TeamTrail::Point& point : trail.points)
      points.push_back({seconds(point.t), meters(point.at.x), meters(point.at.y)});
    robots.push_back({{"id", trail.robot}, {"points", std::move(points)}});
  }
  return dumped({{"robots", std::move(robots)}});
}

}  // namespace tassilo
