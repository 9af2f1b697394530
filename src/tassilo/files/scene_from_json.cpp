#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "tassilo/files/json.h"
#include "tassilo/files/scene_json.h"
#include "tassilo/files/text.h"

namespace tassilo {
namespace {

/// The enumerator whose to_string is the text.
template <class Enum, std::size_t N>
Enum enum_of(const Value& value, const std::array<Enum, N>& all) {
  std::array<std::string_view, N> names;
  for (std::size_t i = 0; i < N; ++i) names[i] = to_string(all[i]);
  return all[value.choice(names)];
}

PixelBox box_of(const Value& value) {
  std::array<int, 4> ends;
  const auto values = value.list(4, 4);
  for (std::size_t i = 0; i < 4; ++i)
    ends[i] = static_cast<int>(values[i].integer(std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
  return {ends[0], ends[1], ends[2], ends[3]};
}

template <class Frame>
Point2<Frame> point_of(const Value& value) {
  const auto n = value.numbers(2);
  return {n[0], n[1]};
}
PixelPoint pixel_of(const Value& value) { return point_of<ImageFrame>(value); }
FloorPoint floor_point_of(const Value& value) { return point_of<RobotFrame>(value); }

Eigen::Matrix2d covariance_of(const Value& value) {
  const auto n = value.numbers(4);
  Eigen::Matrix2d covariance;
  covariance << n[0], n[1], n[2], n[3];
  return covariance;
}

/// Floor values of one object are there together or missing together.
bool has_floor(const Map& map, std::initializer_list<const char*> keys) {
  const bool there = !map.at(*keys.begin()).is_null();
  for (const char* key : keys)
    if (map.at(key).is_null() == there)
      map.at(key).fail(std::string(there ? "is null" : "is not null") + ", must be like " + *keys.begin());
  return there;
}

DistanceBounds bounds_of(const Map& map) {
  const Value far = map.at("far");
  return {map.at("near").number(), far.is_null() ? std::numeric_limits<double>::infinity() : far.number()};
}

Gaussian2<RobotFrame> floor_gaussian_of(const Map& map) {
  map.at("distance").number(0);  // follows from x and y, as does bearing
  map.at("bearing").number();
  return {{map.at("x").number(), map.at("y").number()}, covariance_of(map.at("cov"))};
}

void expect_no_far(const Map& map) {
  if (!map.at("far").is_null()) map.at("far").fail("is not null, must be like x");
}

template <std::size_t N>
std::array<double, N> covariance_of(const Value& value) {
  const auto numbers = value.numbers(N);
  std::array<double, N> covariance;
  std::ranges::copy(numbers, covariance.begin());
  return covariance;
}

PoseSeen pose_of(const Value& value) {
  constexpr std::array kKinds{PoseKind::two_lines, PoseKind::one_line, PoseKind::predicted,
                              PoseKind::goal,      PoseKind::model,    PoseKind::start};
  const Map map = value.map({"x", "y", "theta", "cov", "kind", "age", "mirror"});
  PoseSeen pose;
  pose.x = map.at("x").number();
  pose.y = map.at("y").number();
  pose.theta = map.at("theta").number();
  pose.covariance = covariance_of<9>(map.at("cov"));
  pose.kind = enum_of(map.at("kind"), kKinds);
  pose.age = map.at("age").number(0);
  pose.mirror = map.at("mirror").boolean();
  return pose;
}

Ball ball_of(const Value& value) {
  const Map map =
      value.map({"x", "y", "distance", "bearing", "near", "far", "cov", "box", "center", "radius_px", "confidence"});
  Ball ball;
  ball.box = box_of(map.at("box"));
  ball.center = pixel_of(map.at("center"));
  ball.radius_px = map.at("radius_px").number(0);
  ball.confidence = map.at("confidence").number(0, 1);
  if (has_floor(map, {"x", "y", "distance", "bearing", "near", "cov"}))
    ball.floor = BallOnFloor{floor_gaussian_of(map), bounds_of(map)};
  else
    expect_no_far(map);
  return ball;
}

Goal goal_of(const Value& value) {
  const Map map = value.map({"color", "box", "bearing", "x", "y", "posts"});
  Goal goal;
  goal.color = enum_of(map.at("color"), std::array{GoalColor::yellow, GoalColor::blue});
  goal.box = box_of(map.at("box"));
  if (const Value bearing = map.at("bearing"); !bearing.is_null()) goal.bearing = bearing.number();
  if (has_floor(map, {"x", "y"})) goal.position = FloorPoint{map.at("x").number(), map.at("y").number()};
  for (const Value& entry : map.at("posts").list()) {
    const Map post = entry.map({"side", "x", "y"});
    goal.posts.push_back({enum_of(post.at("side"), std::array{PostSide::left, PostSide::right}),
                          {post.at("x").number(), post.at("y").number()}});
  }
  return goal;
}

RobotSeen robot_of(const Value& value) {
  const Map map = value.map({"team", "x", "y", "distance", "bearing", "near", "far", "center", "cov", "width", "box"});
  RobotSeen robot;
  robot.team = enum_of(map.at("team"), std::array{Team::cyan, Team::magenta, Team::unknown});
  robot.box = box_of(map.at("box"));
  if (has_floor(map, {"x", "y", "distance", "bearing", "near", "center", "cov", "width"}))
    robot.floor = RobotOnFloor{floor_gaussian_of(map), bounds_of(map), floor_point_of(map.at("center")),
                               map.at("width").number(0)};
  else
    expect_no_far(map);
  return robot;
}

void add_line(const Value& value, Scene& scene) {
  constexpr std::array<std::string_view, 3> kKinds{"line", "boundary", "circle"};
  const std::size_t kind = value.any_map().at("kind").choice(kKinds);
  if (kKinds[kind] == "circle") {
    const Map map = value.map({"kind", "center", "radius"});
    scene.circles.push_back({floor_point_of(map.at("center")), map.at("radius").number(0)});
    return;
  }
  const Map map = value.map({"kind", "p", "q", "image", "model"});
  LineSeen line;
  line.kind = kKinds[kind] == "line" ? LineKind::line : LineKind::boundary;
  const auto ends = map.at("image").list(2, 2);
  line.image_p = pixel_of(ends[0]);
  line.image_q = pixel_of(ends[1]);
  if (has_floor(map, {"p", "q"})) line.floor = {floor_point_of(map.at("p")), floor_point_of(map.at("q"))};
  if (const Value model = map.at("model"); !model.is_null()) line.model = model.string();
  scene.lines.push_back(std::move(line));
}

FreeSpace free_space_of(const Value& value) {
  const Map map = value.map({"origin", "angle_min", "angle_increment", "ranges", "state"});
  FreeSpace space;
  space.origin = floor_point_of(map.at("origin"));
  space.angle_min = map.at("angle_min").number();
  space.angle_increment = map.at("angle_increment").positive();
  const auto ranges = map.at("ranges").list();
  const auto states = map.at("state").list(ranges.size(), ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const SectorState state =
        enum_of(states[i], std::array{SectorState::blocked, SectorState::free, SectorState::unseen});
    const bool unseen = state == SectorState::unseen;
    if (unseen != ranges[i].is_null())
      ranges[i].fail(unseen ? "is not null, must be where unseen" : "is null, must be a number unless unseen");
    space.states.push_back(state);
    space.ranges.push_back(unseen ? 0.0 : ranges[i].number(0));
  }
  return space;
}

TrackSeen track_of(const Value& value) {
  const Map map = value.map({"id", "kind", "team", "x", "y", "vx", "vy", "cov", "age"});
  TrackSeen track;
  track.id = static_cast<int>(map.at("id").integer(1, std::numeric_limits<int>::max()));
  track.kind = enum_of(map.at("kind"), std::array{TrackKind::ball, TrackKind::robot});
  track.team = enum_of(map.at("team"), std::array{Team::cyan, Team::magenta, Team::unknown});
  track.x = map.at("x").number();
  track.y = map.at("y").number();
  track.vx = map.at("vx").number();
  track.vy = map.at("vy").number();
  track.covariance = covariance_of<16>(map.at("cov"));
  track.age = map.at("age").number(0);
  return track;
}

Scene scene_of(const Value& root) {
  const Map map = root.map(
      {"frame", "t", "image", "pose", "balls", "goals", "robots", "lines", "free_space", "tracks", "why", "timing_ms"});
  Scene scene;
  scene.frame = map.at("frame").integer(0);
  scene.t = map.at("t").number();
  if (const auto image = map.find("image")) scene.image = image->string();
  if (const Value pose = map.at("pose"); !pose.is_null()) scene.pose = pose_of(pose);
  for (const Value& ball : map.at("balls").list()) scene.balls.push_back(ball_of(ball));
  for (const Value& goal : map.at("goals").list()) scene.goals.push_back(goal_of(goal));
  for (const Value& robot : map.at("robots").list()) scene.robots.push_back(robot_of(robot));
  for (const Value& line : map.at("lines").list()) add_line(line, scene);
  if (const Value space = map.at("free_space"); !space.is_null()) scene.free_space = free_space_of(space);
  // Lines from before there were tracks are read as well.
  if (const auto tracks = map.find("tracks"))
    for (const Value& track : tracks->list()) scene.tracks.push_back(track_of(track));
  for (const auto& [subject, reason] : map.at("why").any_map().entries())
    scene.why.emplace_back(subject, std::string_view(reason.string()));
  const Map timing = map.at("timing_ms").any_map();
  timing.at("total");
  for (const auto& [stage, ms] : timing.entries()) scene.timing.push_back({stage, ms.number(0)});
  return scene;
}

}  // namespace

Scene scene_from_json(std::string_view line, std::string_view place) { return scene_of(parse_json(line, place)); }

std::vector<Scene> read_scenes(const std::filesystem::path& file) {
  constexpr std::size_t kMaxLine = std::size_t{16} << 20;
  std::vector<Scene> scenes;
  LineReader lines(file, kMaxLine);
  while (const auto line = lines.next()) scenes.push_back(scene_from_json(*line, lines.place()));
  return scenes;
}

}  // namespace tassilo
