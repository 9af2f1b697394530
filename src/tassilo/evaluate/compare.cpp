#include "tassilo/evaluate/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <tuple>
#include <utility>

#include "tassilo/base/error.h"
#include "tassilo/evaluate/internal/boxes.h"
#include "tassilo/evaluate/internal/statistics.h"
#include "tassilo/files/scene_json.h"
#include "tassilo/files/text.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/scene/scene.h"

namespace tassilo {
namespace {

constexpr double kSameTime = 0.01;     ///< Containers round time stamps. [s]
constexpr double kSameLine = 0.25;     ///< Of the longer line's length.
constexpr double kSameCircle = 1;      ///< [m]
constexpr double kSameSectors = 1e-9;  ///< [m], [rad]

struct SceneLine {
  Scene scene;
  nlohmann::json json;  ///< All keys but `frame` and `timing_ms`.
};
using SceneLines = std::map<std::int64_t, SceneLine>;

SceneLines read_lines(const std::filesystem::path& file) {
  constexpr std::size_t kMaxLine = std::size_t{16} << 20;
  SceneLines out;
  LineReader lines(file, kMaxLine);
  while (const auto line = lines.next()) {
    SceneLine read{scene_from_json(*line, lines.place()), nlohmann::json::parse(*line)};
    read.json.erase("frame");
    read.json.erase("timing_ms");
    const std::int64_t frame = read.scene.frame;
    if (!out.emplace(frame, std::move(read)).second)
      throw Error(lines.place(), "frame " + std::to_string(frame) + " appears twice, must be one line a frame");
  }
  if (out.empty()) throw Error(file.string(), "has no lines, must have one a frame");
  return out;
}

/// Pairs things of one frame, the most alike first, each thing at most once, and counts what is paired and what is
/// left. `likeness` of two things is nothing where they cannot be the same. Swapping a and b swaps all pairs: of two
/// equally good ones that share a thing, the one with the lower sum of indices comes first.
template <class Things, class Likeness>
auto pair_up(Paired& counts, const Things& a, const Things& b, Likeness likeness) {
  std::vector<std::tuple<double, std::size_t, std::size_t, std::size_t>> candidates;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k)
      if (const std::optional<double> alike = likeness(a[i], b[k])) candidates.emplace_back(-*alike, i + k, i, k);
  std::ranges::sort(candidates);
  using Thing = typename Things::value_type;
  std::vector<std::pair<const Thing&, const Thing&>> out;
  std::vector<bool> taken_a(a.size()), taken_b(b.size());
  for (const auto& [unlike, sum, i, k] : candidates) {
    if (taken_a[i] || taken_b[k]) continue;
    taken_a[i] = taken_b[k] = true;
    out.emplace_back(a[i], b[k]);
  }
  counts.both += static_cast<std::int64_t>(out.size());
  counts.only_a += static_cast<std::int64_t>(a.size() - out.size());
  counts.only_b += static_cast<std::int64_t>(b.size() - out.size());
  return out;
}
/// The same for a thing that there is at most once; returns whether both have it.
bool count_presence(Paired& counts, bool in_a, bool in_b) {
  counts.both += in_a && in_b;
  counts.only_a += in_a && !in_b;
  counts.only_b += !in_a && in_b;
  return in_a && in_b;
}

ScoreBox score_box(const PixelBox& box) {
  return {static_cast<double>(box.x0), static_cast<double>(box.y0), static_cast<double>(box.x1),
          static_cast<double>(box.y1)};
}
std::optional<double> box_likeness(const PixelBox& a, const PixelBox& b) {
  const double overlap = intersection_over_union(a, b);
  return overlap >= kMinOverlap ? std::optional(overlap) : std::nullopt;
}
std::optional<double> ball_likeness(const Ball& a, const Ball& b) {
  if (!same_ball(score_box(a.box), score_box(b.box))) return std::nullopt;
  const double overlap = intersection_over_union(a.box, b.box);
  return overlap > 0 ? overlap : -distance(a.center, b.center);
}

/// In [0, 180]; to the last bit the same for swapped angles. [deg] of [rad]
double angle_between_deg(double a, double b) { return std::abs(degrees(wrap_angle(std::abs(a - b)))); }

double distance_to_segment(PixelPoint point, PixelPoint p, PixelPoint q) {
  const PixelPoint along = q - p;
  const double length_2 = dot(along, along);
  const double share = length_2 > 0 ? std::clamp(dot(point - p, along) / length_2, 0., 1.) : 0.;
  return distance(point, p + share * along);
}
/// Hausdorff distance of two segments: an end is furthest. [px]
double distance_of_lines(const LineSeen& a, const LineSeen& b) {
  return std::max(
      {distance_to_segment(a.image_p, b.image_p, b.image_q), distance_to_segment(a.image_q, b.image_p, b.image_q),
       distance_to_segment(b.image_p, a.image_p, a.image_q), distance_to_segment(b.image_q, a.image_p, a.image_q)});
}
std::optional<double> line_likeness(const LineSeen& a, const LineSeen& b) {
  const double apart = distance_of_lines(a, b);
  const double length = std::max(distance(a.image_p, a.image_q), distance(b.image_p, b.image_q));
  return a.kind == b.kind && apart <= kSameLine * length ? std::optional(-apart) : std::nullopt;
}

bool same_sectors(const FreeSpace& a, const FreeSpace& b) {
  return a.ranges.size() == b.ranges.size() && distance(a.origin, b.origin) <= kSameSectors &&
         std::abs(a.angle_min - b.angle_min) <= kSameSectors &&
         std::abs(a.angle_increment - b.angle_increment) <= kSameSectors;
}

/// Lists of values whose spreads are told at the end.
struct Differences {
  struct {
    Numbers distance_m, turn_deg;
  } pose;
  struct {
    Numbers distance_m, center_px;
  } balls;
  struct {
    Numbers bearing_deg, distance_m;
  } goals;
  struct {
    Numbers nearest_m, center_m;
  } robots;
  struct {
    Numbers ends_px, center_m;
  } lines;
  Numbers range_m;
};

void add_pose(Comparison& out, Differences& values, const Scene& a, const Scene& b) {
  if (!count_presence(out.pose.frames, a.pose.has_value(), b.pose.has_value())) return;
  values.pose.distance_m.push_back(std::hypot(a.pose->x - b.pose->x, a.pose->y - b.pose->y));
  values.pose.turn_deg.push_back(angle_between_deg(a.pose->theta, b.pose->theta));
  out.pose.kind_differs += a.pose->kind != b.pose->kind;
  out.pose.mirror_differs += a.pose->mirror != b.pose->mirror;
}

void add_balls(Comparison& out, Differences& values, const Scene& a, const Scene& b) {
  for (const auto& [one, other] : pair_up(out.balls.balls, a.balls, b.balls, ball_likeness)) {
    values.balls.center_px.push_back(distance(one.center, other.center));
    if (one.floor && other.floor)
      values.balls.distance_m.push_back(distance(one.floor->position.mean, other.floor->position.mean));
  }
}

void add_goals(Comparison& out, Differences& values, const Scene& a, const Scene& b) {
  const auto likeness = [](const Goal& one, const Goal& other) {
    return one.color == other.color ? box_likeness(one.box, other.box) : std::nullopt;
  };
  for (const auto& [one, other] : pair_up(out.goals.goals, a.goals, b.goals, likeness)) {
    if (one.bearing && other.bearing)
      values.goals.bearing_deg.push_back(angle_between_deg(*one.bearing, *other.bearing));
    if (one.position && other.position) values.goals.distance_m.push_back(distance(*one.position, *other.position));
  }
}

void add_robots(Comparison& out, Differences& values, const Scene& a, const Scene& b) {
  const auto likeness = [](const RobotSeen& one, const RobotSeen& other) { return box_likeness(one.box, other.box); };
  for (const auto& [one, other] : pair_up(out.robots.robots, a.robots, b.robots, likeness)) {
    out.robots.team_differs += one.team != other.team;
    if (!one.floor || !other.floor) continue;
    values.robots.nearest_m.push_back(distance(one.floor->nearest.mean, other.floor->nearest.mean));
    values.robots.center_m.push_back(distance(one.floor->center, other.floor->center));
  }
}

void add_lines(Comparison& out, Differences& values, const Scene& a, const Scene& b) {
  for (const auto& [one, other] : pair_up(out.lines.lines, a.lines, b.lines, line_likeness)) {
    values.lines.ends_px.push_back(distance_of_lines(one, other));
    out.lines.model_differs += one.model != other.model;
  }
  const auto likeness = [](const CircleSeen& one, const CircleSeen& other) {
    const double apart = distance(one.center, other.center);
    return apart <= kSameCircle ? std::optional(-apart) : std::nullopt;
  };
  for (const auto& [one, other] : pair_up(out.lines.circles, a.circles, b.circles, likeness)) {
    values.lines.center_m.push_back(distance(one.center, other.center));
  }
}

void add_free_space(Comparison& out, Differences& values, const Scene& a, const Scene& b) {
  FreeSpaceDifference& space = out.free_space;
  if (!count_presence(space.frames, a.free_space.has_value(), b.free_space.has_value())) return;
  if (!same_sectors(*a.free_space, *b.free_space)) {
    ++space.other_sectors;
    return;
  }
  for (std::size_t i = 0; i < a.free_space->ranges.size(); ++i) {
    const SectorState one = a.free_space->states[i], other = b.free_space->states[i];
    ++space.sectors;
    space.state_differs += one != other;
    if (one != SectorState::unseen && other != SectorState::unseen)
      values.range_m.push_back(std::abs(a.free_space->ranges[i] - b.free_space->ranges[i]));
  }
}

void tell_spreads(Comparison& out, const Differences& values) {
  out.pose.distance_m = spread(values.pose.distance_m);
  out.pose.turn_deg = spread(values.pose.turn_deg);
  out.balls.distance_m = spread(values.balls.distance_m);
  out.balls.center_px = spread(values.balls.center_px);
  out.goals.bearing_deg = spread(values.goals.bearing_deg);
  out.goals.distance_m = spread(values.goals.distance_m);
  out.robots.nearest_m = spread(values.robots.nearest_m);
  out.robots.center_m = spread(values.robots.center_m);
  out.lines.ends_px = spread(values.lines.ends_px);
  out.lines.center_m = spread(values.lines.center_m);
  out.free_space.range_m = spread(values.range_m);
}

/// Throws Error unless both lines may be of one frame of one recording.
void check_same_frame(const CompareOptions& options, const Scene& a, const Scene& b) {
  const std::string frame = "frame " + std::to_string(a.frame) + " is ";
  if (std::abs(a.t - b.t) > kSameTime)
    throw Error(options.b.string(), frame + "at t = " + std::to_string(b.t) + " s, must be at " + std::to_string(a.t) +
                                        " s as in " + options.a.string() + ": runs of one recording are compared");
  if (a.image != b.image)
    throw Error(options.b.string(), frame + (b.image.empty() ? "no image" : "image " + b.image) + ", must be " +
                                        (a.image.empty() ? "none" : a.image) + " as in " + options.a.string() +
                                        ": runs of one recording are compared");
}

/// Frames in which values differ, by key: those of every scene line first, in their order.
class Subjects {
 public:
  Subjects() {
    for (const char* key : {"t", "pose", "balls", "goals", "robots", "lines", "free_space"}) out_.push_back({key, {}});
  }
  void add(std::int64_t frame, const nlohmann::json& a, const nlohmann::json& b) {
    for (const auto& [key, value] : a.items()) {
      const auto in_b = b.find(key);
      add(frame, key, in_b != b.end() && *in_b == value);
    }
    for (const auto& [key, value] : b.items())
      if (!a.contains(key)) add(frame, key, false);
  }
  std::vector<SubjectDifference> take() && { return std::move(out_); }

 private:
  void add(std::int64_t frame, const std::string& key, bool equal) {
    auto at = std::ranges::find(out_, key, &SubjectDifference::subject);
    if (at == out_.end()) {
      const auto by_name = [](const SubjectDifference& one, const std::string& name) { return one.subject < name; };
      at = out_.insert(std::lower_bound(out_.begin() + kFirst, out_.end(), key, by_name), {key, {}});
    }
    if (!equal) at->frames.push_back(frame);
  }

  static constexpr std::ptrdiff_t kFirst = 7;
  std::vector<SubjectDifference> out_;
};

std::map<std::string, StageTimes> stage_times(const std::map<std::string, Numbers>& timing) {
  std::map<std::string, StageTimes> out;
  for (const auto& [stage, ms] : timing) out[stage] = {quantile(ms, .5), quantile(ms, .99), maximum(ms)};
  return out;
}

void add_times(std::map<std::string, Numbers>& timing, const Scene& scene) {
  for (const StageTime& time : scene.timing) timing[time.stage].push_back(time.ms);
}

Evaluation measured(const CompareOptions& options, const std::filesystem::path& scenes) {
  EvaluateOptions evaluate_options;
  evaluate_options.sequences.push_back({*options.truth, scenes});
  evaluate_options.meta = options.meta;
  return evaluate(evaluate_options);
}

}  // namespace

Comparison compare(const CompareOptions& options) {
  const SceneLines a = read_lines(options.a), b = read_lines(options.b);
  Comparison out;
  out.name_a = options.a.string();
  out.name_b = options.b.string();
  Subjects subjects;
  Differences values;
  std::map<std::string, Numbers> timing_a, timing_b;
  for (const auto& [frame, one] : a) {
    const auto at = b.find(frame);
    if (at == b.end()) {
      out.only_a.push_back(frame);
      continue;
    }
    const SceneLine& other = at->second;
    check_same_frame(options, one.scene, other.scene);
    ++out.frames;
    out.equal_frames += one.json == other.json;
    subjects.add(frame, one.json, other.json);
    for (const auto add : {add_pose, add_balls, add_goals, add_robots, add_lines, add_free_space})
      add(out, values, one.scene, other.scene);
    add_times(timing_a, one.scene);
    add_times(timing_b, other.scene);
  }
  for (const auto& [frame, other] : b)
    if (!a.contains(frame)) out.only_b.push_back(frame);
  if (out.frames == 0)
    throw Error(options.b.string(), "has no frame of " + options.a.string() + ", must be a run of the same recording");
  out.subjects = std::move(subjects).take();
  tell_spreads(out, values);
  out.timing_ms_a = stage_times(timing_a);
  out.timing_ms_b = stage_times(timing_b);
  if (options.truth) {
    out.truth_a = measured(options, options.a);
    out.truth_b = measured(options, options.b);
  }
  return out;
}

}  // namespace tassilo
