#include "tassilo/evaluate/internal/records.h"

#include <algorithm>
#include <numbers>
#include <string_view>

#include "tassilo/base/error.h"
#include "tassilo/files/json.h"
#include "tassilo/files/text.h"
#include "tassilo/files/yaml.h"

namespace tassilo {
namespace {

constexpr std::size_t kMaxLine = std::size_t{16} << 20, kMaxFile = std::size_t{64} << 20;

std::optional<double> number_or_null(const Value& value) {
  return value.is_null() ? std::nullopt : std::optional(value.number());
}

template <std::size_t n>
std::array<double, n> numbers_of(const Value& value) {
  std::array<double, n> out;
  std::ranges::copy(value.numbers(n), out.begin());
  return out;
}

/// The elements of a list, each through `read`.
template <class Read>
auto each(const Value& list, Read read) {
  std::vector<decltype(read(list))> out;
  for (const Value& value : list.list()) out.push_back(read(value));
  return out;
}

/// A key that may be missing or null.
std::optional<Value> given(const Map& map, std::string_view key) {
  auto value = map.find(key);
  return value && !value->is_null() ? value : std::nullopt;
}

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

constexpr std::array<std::string_view, 6> kPoseKinds{"two_lines", "one_line", "predicted", "goal", "model", "start"};
constexpr std::array<std::string_view, 2> kGoalNames{"yellow", "blue"};
constexpr std::array<std::string_view, 3> kTeams{"cyan", "magenta", "unknown"};
constexpr std::array<std::string_view, 3> kStates{"blocked", "free", "unseen"};
constexpr std::array<std::string_view, 2> kShapes{"box", "cylinder"};

ReportedPose read_pose(const Value& value) {
  const Map map = value.any_map();
  const auto mirror = given(map, "mirror");
  return {.x = map.at("x").number(),
          .y = map.at("y").number(),
          .theta = map.at("theta").number(),
          .covariance = map.at("cov").numbers(9),
          .predicted = kPoseKinds[map.at("kind").choice(kPoseKinds)] == "predicted",
          .mirror = mirror && mirror->boolean()};
}

ReportedPlace read_place(const Map& map) {
  const auto value = [&](std::string_view key) { return number_or_null(map.at(key)); };
  return {value("x"), value("y"), value("distance"), value("near"), value("far")};
}

ReportedBall read_ball(const Value& value) {
  const Map map = value.any_map();
  const Value covariance = map.at("cov");
  return {read_place(map), covariance.is_null() ? std::vector<double>() : covariance.numbers(4),
          numbers_of<4>(map.at("box"))};
}

ReportedGoal read_goal(const Value& value) {
  const Map map = value.any_map();
  return {static_cast<GoalName>(map.at("color").choice(kGoalNames)), numbers_of<4>(map.at("box")),
          number_or_null(map.at("bearing"))};
}

ReportedRobot read_robot(const Value& value) {
  const Map map = value.any_map();
  ReportedRobot out{
      std::string(kTeams[map.at("team").choice(kTeams)]), read_place(map), {}, numbers_of<4>(map.at("box"))};
  if (const auto center = given(map, "center")) out.center = numbers_of<2>(*center);
  return out;
}

ReportedFreeSpace read_free_space(const Value& value) {
  const Map map = value.any_map();
  ReportedFreeSpace out{.origin = numbers_of<2>(map.at("origin")),
                        .angle_min = map.at("angle_min").number(),
                        .angle_increment = map.at("angle_increment").positive(),
                        .ranges = {},
                        .states = each(map.at("state"), [](const Value& state) {
                          return static_cast<ReportedState>(state.choice(kStates));
                        })};
  const auto ranges = map.at("ranges").list();
  if (ranges.size() != out.states.size())
    value.fail("has " + std::to_string(ranges.size()) + " ranges but " + std::to_string(out.states.size()) + " states");
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const bool unseen = out.states[i] == ReportedState::unseen;
    if (ranges[i].is_null() != unseen)
      ranges[i].fail(std::string(unseen ? "is a range" : "is null") + " but its state is " +
                     std::string(kStates[static_cast<std::size_t>(out.states[i])]));
    out.ranges.push_back(unseen ? 0 : ranges[i].number());
  }
  return out;
}

ReportedScene read_scene(const Map& map) {
  ReportedScene out{.frame = map.at("frame").integer(),
                    .t = map.at("t").number(),
                    .image = {},
                    .pose = {},
                    .balls = each(map.at("balls"), read_ball),
                    .goals = each(map.at("goals"), read_goal),
                    .robots = each(map.at("robots"), read_robot),
                    .free_space = {},
                    .timing_ms = {},
                    .has_unscored = map.find("lines") && map.find("why"),
                    .place = {}};
  if (const auto image = given(map, "image")) out.image = file_name(image->string());
  if (const Value pose = map.at("pose"); !pose.is_null()) out.pose = read_pose(pose);
  if (const Value free = map.at("free_space"); !free.is_null()) out.free_space = read_free_space(free);
  const Map timing = map.at("timing_ms").any_map();
  timing.at("total");
  for (const auto& [stage, ms] : timing.entries()) out.timing_ms.emplace_back(stage, ms.number());
  return out;
}

std::optional<ScoreBox> read_true_box(const Value& value) {
  if (value.is_null()) return std::nullopt;
  ScoreBox box = numbers_of<4>(value);  // inclusive ends in the file
  box[2] += 1;
  box[3] += 1;
  return box;
}

TrueView read_view(const Map& map) {
  return {map.at("visible_px").integer(), map.at("visible_fraction").number(), read_true_box(map.at("bbox")),
          read_true_box(map.at("bbox_full")), map.at("truncated").boolean()};
}

TrueGoal read_true_goal(const Value& value) {
  const Map map = value.any_map();
  return {map.at("rx").number(), map.at("ry").number(), read_view(map)};
}

TruePose read_true_pose(const Map& map, std::string_view x = "x", std::string_view y = "y",
                        std::string_view theta = "theta") {
  return {map.at(x).number(), map.at(y).number(), map.at(theta).number()};
}

TrueRobot read_true_robot(const Value& value) {
  const Map map = value.any_map();
  return {read_true_pose(map),           read_true_pose(map, "rx", "ry", "rtheta"),
          map.at("team_color").string(), map.at("shape").choice(kShapes) == 0,
          map.at("size").numbers(3),     read_view(map)};
}

TrueFrame read_true_frame(const Map& map) {
  const Map ball = map.at("ball").any_map(), goals = map.at("goals").any_map();
  const Map free = map.at("free").any_map().at("camera").any_map();
  TrueFrame out{.t = map.at("t").number(),
                .robot = read_true_pose(map.at("robot").any_map()),
                .ball = {ball.at("rx").number(), ball.at("ry").number(), ball.at("dist").number(), read_view(ball)},
                .robots = each(map.at("robots"), read_true_robot),
                .goals = {read_true_goal(goals.at("yellow")), read_true_goal(goals.at("blue"))},
                .free_origin = numbers_of<2>(free.at("origin")),
                .feet = {}};
  const auto rays = each(free.at("ray"), number_or_null);
  const auto shown =
      each(free.at("foot_px"), [](const Value& foot) { return !foot.is_null() && !foot.numbers(2).empty(); });
  const auto hidden = each(free.at("foot_hidden"), [](const Value& foot) { return !foot.is_null() && foot.boolean(); });
  for (std::size_t k = 0; k < std::min({rays.size(), shown.size(), hidden.size()}); ++k) {
    if (rays[k] && shown[k] && !hidden[k])
      out.feet.push_back({2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(rays.size()), *rays[k]});
  }
  return out;
}

/// Calls take(map, place) for every line, an object each.
template <class Take>
void for_each_line(const std::filesystem::path& file, Take take) {
  LineReader lines(file, kMaxLine);
  while (const auto line = lines.next()) {
    const std::string place = lines.place();
    if (line->find_first_not_of(" \t\r") == std::string_view::npos)
      throw Error(place, "is an empty line, must be an object");
    take(parse_json(*line, place).any_map(), place);
  }
  if (lines.line() == 0) throw Error(file.string(), "has no lines, must have one a frame");
}

void refuse_second(bool is_new, std::int64_t frame, const std::string& place) {
  if (!is_new) throw Error(place, "frame " + std::to_string(frame) + " appears twice, must be one line a frame");
}

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> out(1);
  for (const char c : line) {
    if (c == ',')
      out.emplace_back();
    else
      out.back() += c;
  }
  return out;
}

}  // namespace

std::map<std::int64_t, TrueFrame> read_truth(const std::filesystem::path& file) {
  std::map<std::int64_t, TrueFrame> out;
  for_each_line(file, [&](const Map& map, const std::string& place) {
    const std::int64_t frame = map.at("frame").integer();
    refuse_second(out.emplace(frame, read_true_frame(map)).second, frame, place);
  });
  return out;
}

std::map<std::int64_t, ReportedScene> read_scenes(const std::filesystem::path& file,
                                                  const std::map<std::int64_t, TrueFrame>& truth,
                                                  const std::filesystem::path& truth_file) {
  std::map<std::int64_t, ReportedScene> out;
  for_each_line(file, [&](const Map& map, const std::string& place) {
    ReportedScene scene = read_scene(map);
    const std::int64_t frame = scene.frame;
    if (!truth.contains(frame))
      throw Error(place, "frame " + std::to_string(frame) + " is not in " + truth_file.string() + ", must be within " +
                             std::to_string(truth.begin()->first) + " and " + std::to_string(truth.rbegin()->first));
    refuse_second(out.emplace(frame, std::move(scene)).second, frame, place);
  });
  return out;
}

std::map<std::string, std::vector<ReportedScene>> read_image_scenes(const std::filesystem::path& file) {
  std::map<std::string, std::vector<ReportedScene>> out;
  for_each_line(file, [&](const Map& map, const std::string& place) {
    ReportedScene scene = read_scene(map);
    if (scene.image.empty()) throw Error(place, "key 'image' is missing, must name the image");
    scene.place = place;
    out[scene.image].push_back(std::move(scene));
  });
  return out;
}

TrueField read_true_field(const std::filesystem::path& meta_file) {
  const Map field = parse_json(read_text(meta_file, kMaxFile), meta_file.string()).any_map().at("field").any_map();
  return {field.at("length").positive(), field.at("width").positive(), field.at("goal_width").number(0),
          field.at("goal_depth").number(0), field.at("walls").boolean()};
}

std::vector<TrueBallImage> read_ball_images(const std::filesystem::path& file) {
  const Map map = parse_json(read_text(file, kMaxFile), file.string()).any_map();
  return each(map.at("images"), [](const Value& value) {
    const Map image = value.any_map();
    return TrueBallImage{
        image.at("image").string(),
        each(image.at("balls"), [](const Value& ball) { return numbers_of<4>(ball.any_map().at("box")); }),
        each(image.at("ignore"), numbers_of<4>)};
  });
}

std::vector<std::string> read_sample_images(const std::filesystem::path& file) {
  std::vector<std::string> out;
  for (const Value& sample : read_yaml(file).list(1)) out.push_back(file_name(sample.any_map().at("image").string()));
  return out;
}

std::vector<TrueImagePose> read_image_poses(const std::filesystem::path& file) {
  LineReader lines(file, kMaxLine);
  std::vector<std::string> columns;
  std::vector<TrueImagePose> out;
  while (const auto line = lines.next()) {
    if (line->empty()) continue;
    const auto cells = split(*line);
    if (columns.empty()) {
      columns = cells;
      continue;
    }
    const auto cell = [&](std::string_view name) {
      const auto column = static_cast<std::size_t>(std::ranges::find(columns, name) - columns.begin());
      if (column >= std::min(columns.size(), cells.size()))
        throw Error(lines.place(), "has no " + std::string(name) + ", must have image, x, y, theta and quality");
      return Setting{lines.place(), std::string(name), cells[column]};
    };
    TrueImagePose pose{file_name(cell("image").text),
                       {cell("x").number(), cell("y").number(), cell("theta").number()},
                       cell("quality").text};
    const auto same = std::ranges::find(out, pose.image, &TrueImagePose::image);
    if (same == out.end())
      out.push_back(std::move(pose));
    else
      *same = std::move(pose);
  }
  if (out.empty()) throw Error(file.string(), "has no poses, must have one a line below the names of its columns");
  return out;
}

}  // namespace tassilo
