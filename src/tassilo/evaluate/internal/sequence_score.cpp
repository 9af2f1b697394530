#include "tassilo/evaluate/internal/sequence_score.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "tassilo/evaluate/internal/boxes.h"
#include "tassilo/evaluate/internal/pose_judgement.h"
#include "tassilo/evaluate/internal/true_ranges.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

constexpr double kMinFraction = 0.5;  ///< Of an object that must be seen.
constexpr std::int64_t kBallMinPx = 20, kGoalMinPx = 40, kRobotMinPx = 20;
constexpr double kRobotMaxRange = 5, kRobotMatch = 0.4, kFreeMaxRange = 4;

bool clear(const TrueView& view, std::int64_t min_px) {
  return view.visible_px >= min_px && view.visible_fraction >= kMinFraction;
}

bool any_box(const TrueView& view, auto holds) {
  return (view.visible && holds(*view.visible)) || (view.whole && holds(*view.whole));
}

double overlap(const ScoreBox& box, const TrueView& view) {
  double best = 0;
  any_box(view, [&](const ScoreBox& seen) {
    best = std::max(best, intersection_over_union(box, seen));
    return false;
  });
  return best;
}

/// Pose, one frame; returns whether it is good.
bool add_pose(Samples::Pose& s, const TrueFrame& truth, const ReportedScene* scene) {
  const auto* pose = scene && scene->pose ? &*scene->pose : nullptr;
  s.there.add(pose);
  if (!pose) {
    s.good.add(false);
    s.good_mirrored.add(false);
    return false;
  }
  const PoseJudgement judged = judge_pose(*pose, truth.robot);
  s.position_m.push_back(judged.position_m);
  s.heading_deg.push_back(judged.heading_deg);
  s.good.add(judged.good);
  s.good_mirrored.add(judged.good_mirrored);
  s.wrong.add(judged.wrong);
  s.mirror.add(pose->mirror);
  const auto nees = normalized_squared_error(judged.error, pose->covariance);
  s.bad_covariance.add(!nees);
  if (nees) s.nees.push_back(*nees);
  return judged.good;
}

/// What a sequence says of its first fix; one value a frame.
struct PoseStep {
  bool sure = false;  ///< A pose that is not perhaps mirrored.
  bool predicted = false, good = false;
};
void add_fix(Samples::Pose& s, const std::vector<PoseStep>& steps) {
  const auto fix = std::ranges::find_if(steps, [](const PoseStep& step) { return step.sure && !step.predicted; });
  const bool fixed = fix != steps.end();
  s.first_fix.push_back(fixed ? static_cast<double>(fix - steps.begin()) : std::numeric_limits<double>::infinity());
  for (auto step = fixed ? fix + 1 : steps.begin(); step != steps.end(); ++step) {
    s.after_fix.add(fixed && step->sure);
    s.good_after_fix.add(fixed && step->good);
  }
}

void add_bounds(Samples::Placed& s, const ReportedPlace& place, double distance, double scale) {
  const bool there = place.near && place.far;
  s.bracketed.add(there && *place.near <= distance && distance <= *place.far);
  if (there) s.bracket_width.push_back((*place.far - *place.near) / scale);
}

void add_floor_notes(Samples::Placed& s, const ReportedPlace& place) {
  const bool there = place.x && place.y && place.distance;
  s.without_floor.add(!there);
  s.inconsistent.add(there && std::abs(std::hypot(*place.x, *place.y) - *place.distance) > .02 + .01 * *place.distance);
}

void add_ball(Samples::Ball& s, const TrueBall& truth, const ReportedScene* scene) {
  static const std::vector<ReportedBall> none;
  const auto& balls = scene ? scene->balls : none;
  const auto is_true = [&](const ReportedBall& ball) {
    return truth.view.visible && any_box(truth.view, [&](const ScoreBox& seen) { return same_ball(ball.box, seen); });
  };
  const auto first = std::ranges::find_if(balls, is_true);
  for (auto ball = balls.begin(); ball != balls.end(); ++ball)
    s.precision_all.add(ball == first);  // a second box is false
  const bool best = first == balls.begin() && first != balls.end();
  if (!balls.empty()) {
    s.precision_best.add(best);
    add_floor_notes(s, balls[0].floor);
  }
  if (!clear(truth.view, kBallMinPx)) return;
  s.recall_best.add(best);
  s.recall_any.add(first != balls.end());
  if (!best) return;

  const ReportedPlace& place = balls[0].floor;
  add_bounds(s, place, truth.distance, truth.distance);
  if (!place.x || !place.y) return;
  const Eigen::Vector2d error(*place.x - truth.x, *place.y - truth.y);
  s.error_m.push_back(error.norm());
  s.error_relative.push_back(error.norm() / truth.distance);
  const auto nees = balls[0].covariance.empty() ? std::nullopt : normalized_squared_error(error, balls[0].covariance);
  s.bad_covariance.add(!nees);
  if (nees) s.nees.push_back(*nees);
}

void add_goal(Samples::Goal& s, GoalName color, const TrueGoal& truth, const ReportedScene* scene) {
  const ReportedGoal* found = nullptr;
  if (scene) {
    for (const ReportedGoal& goal : scene->goals) {
      if (goal.color != color) continue;
      const bool inside =
          any_box(truth.view, [&](const ScoreBox& seen) { return contains(seen, box_center(goal.box)); });
      const bool right =
          !found && truth.view.visible_px > 0 && (inside || overlap(goal.box, truth.view) >= kMinOverlap);
      if (right) found = &goal;
      s.precision.add(right);
    }
  }
  if (!clear(truth.view, kGoalMinPx)) return;
  s.recall.add(found);
  if (found && !truth.view.truncated && found->bearing)
    s.bearing_deg.push_back(degrees(std::abs(wrap_angle(*found->bearing - std::atan2(truth.y, truth.x)))));
}

/// Reported robot of every true one, one to one, best overlap first; -1: none.
std::vector<int> match_robots(const std::vector<TrueRobot>& truth, const std::vector<FloorPoint>& outline,
                              const std::vector<ReportedRobot>& reported) {
  std::vector<std::tuple<double, double, std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i].view.visible_px <= 0) continue;
    for (std::size_t k = 0; k < reported.size(); ++k) {
      const ReportedPlace& place = reported[k].floor;
      const double common = overlap(reported[k].box, truth[i].view);
      const double away = place.x && place.y ? distance(FloorPoint{*place.x, *place.y}, outline[i])
                                             : std::numeric_limits<double>::infinity();
      if (common >= kMinOverlap || away <= kRobotMatch) pairs.emplace_back(-common, away, i, k);
    }
  }
  std::ranges::sort(pairs);
  std::vector<int> match(truth.size(), -1);
  for (const auto& [common, away, i, k] : pairs)
    if (match[i] < 0 && std::ranges::find(match, static_cast<int>(k)) == match.end()) match[i] = static_cast<int>(k);
  return match;
}

void add_robots(Samples::Robot& s, const std::vector<TrueRobot>& truth, const ReportedScene* scene) {
  static const std::vector<ReportedRobot> none;
  const auto& reported = scene ? scene->robots : none;
  std::vector<FloorPoint> outline;
  for (const TrueRobot& robot : truth) outline.push_back(nearest_outline_point(robot));
  const std::vector<int> match = match_robots(truth, outline, reported);
  for (std::size_t k = 0; k < reported.size(); ++k) {
    s.precision.add(std::ranges::find(match, static_cast<int>(k)) != match.end());
    add_floor_notes(s, reported[k].floor);
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const FloorPoint center{truth[i].in_robot.x, truth[i].in_robot.y};
    if (!clear(truth[i].view, kRobotMinPx) || norm(center) > kRobotMaxRange) continue;
    s.recall.add(match[i] >= 0);
    if (match[i] < 0) continue;
    const ReportedRobot& robot = reported[static_cast<std::size_t>(match[i])];
    s.team_right.add(robot.team == truth[i].team);
    s.team_swapped.add(robot.team != truth[i].team && robot.team != "unknown");
    add_bounds(s, robot.floor, norm(outline[i]), 1);
    if (robot.floor.x && robot.floor.y)
      s.to_nearest_m.push_back(distance(FloorPoint{*robot.floor.x, *robot.floor.y}, outline[i]));
    if (robot.center) s.center_m.push_back(distance(FloorPoint{(*robot.center)[0], (*robot.center)[1]}, center));
  }
}

/// Sector that holds a direction, numbered on around the circle where it lies before sector 0.
double sector_of(double angle, const ReportedFreeSpace& free) {
  const double sector = std::nearbyint(wrap_angle(angle - free.angle_min) / free.angle_increment);
  return sector < 0 ? std::nearbyint(sector + 2 * std::numbers::pi / free.angle_increment) : sector;
}

void add_coverage(Samples::FreeSpace& s, const TrueFrame& truth, const ReportedFreeSpace* free) {
  for (const TrueFoot& foot : truth.feet) {
    if (foot.range >= kFreeMaxRange) continue;
    if (!free) {
      s.coverage.add(false);
      continue;
    }
    const double x = truth.free_origin[0] + foot.range * std::cos(foot.angle) - free->origin[0];
    const double y = truth.free_origin[1] + foot.range * std::sin(foot.angle) - free->origin[1];
    const double sector = sector_of(std::atan2(y, x), *free);
    s.coverage.add(sector < static_cast<double>(free->states.size()) &&
                   free->states[static_cast<std::size_t>(sector)] == ReportedState::blocked);
  }
}

void add_sector(Samples::FreeSpace& s, const TrueObstacles& obstacles, const ReportedFreeSpace& free, std::size_t i) {
  if (free.states[i] == ReportedState::unseen) return;
  const double center = free.angle_min + free.angle_increment * static_cast<double>(i);
  const auto range = [&](double off) { return obstacles.range({free.origin[0], free.origin[1]}, center + off); };
  const double ahead = range(0);
  if (ahead >= kFreeMaxRange) return;
  double longest = ahead, shortest = ahead;
  for (int k = -2; k <= 2; ++k) longest = std::max(longest, range(k / 2. * radians(.5)));
  for (int k = -10; k <= 10; ++k) shortest = std::min(shortest, range(k / 20. * free.angle_increment));

  const double claim = free.ranges[i];
  const bool blocked = free.states[i] == ReportedState::blocked;
  s.dangerous.add(claim > longest * 1.05 + .15);
  s.state_free.add(!blocked);
  if (!blocked) {
    s.range_relative.push_back(ahead > 0 ? claim / ahead : 1);
    return;
  }
  s.error_m.push_back(std::max({0., claim - ahead, shortest - claim}));
  s.timid.add(claim < shortest * .85 - .3);
}

Samples::Goal operator+(Samples::Goal a, const Samples::Goal& b) {
  a.recall = a.recall + b.recall;
  a.precision = a.precision + b.precision;
  a.bearing_deg.insert(a.bearing_deg.end(), b.bearing_deg.begin(), b.bearing_deg.end());
  return a;
}

GoalScore summary_of(const Samples::Goal& s) {
  return {s.recall.share(), s.precision.share(), s.recall.count, s.precision.count, spread(s.bearing_deg)};
}

PoseScore summary_of(const Samples::Pose& s) {
  return {.share = s.there.share(),
          .share_after_fix = s.after_fix.share(),
          .position_m = spread(s.position_m),
          .heading_deg = spread(s.heading_deg),
          .good = s.good.share(),
          .good_mirrored = s.good_mirrored.share(),
          .good_after_fix = s.good_after_fix.share(),
          .wrong = s.wrong.share(),
          .mirror = s.mirror.share(),
          .first_fix = quantile(s.first_fix, .5),
          .never_fixed = std::ranges::count(s.first_fix, std::numeric_limits<double>::infinity()),
          .nees_mean = mean(s.nees),
          .nees_median = quantile(s.nees, .5),
          .bad_covariances = s.bad_covariance.held};
}

BallScore summary_of(const Samples::Ball& s) {
  return {.recall_best = s.recall_best.share(),
          .recall_any = s.recall_any.share(),
          .frames = s.recall_best.count,
          .precision_best = s.precision_best.share(),
          .precision_all = s.precision_all.share(),
          .reported_best = s.precision_best.count,
          .reported = s.precision_all.count,
          .error_m = spread(s.error_m),
          .error_relative = spread(s.error_relative),
          .bracketed = s.bracketed.share(),
          .bracket_width_relative = quantile(s.bracket_width, .5),
          .nees_mean = mean(s.nees)};
}

RobotScore summary_of(const Samples::Robot& s) {
  return {.recall = s.recall.share(),
          .precision = s.precision.share(),
          .robots = s.recall.count,
          .reported = s.precision.count,
          .team_right = s.team_right.share(),
          .team_swapped = s.team_swapped.share(),
          .to_nearest_m = spread(s.to_nearest_m),
          .center_m = spread(s.center_m),
          .bracketed = s.bracketed.share(),
          .bracket_width_m = quantile(s.bracket_width, .5)};
}

FreeSpaceScore summary_of(const Samples::FreeSpace& s) {
  return {.sectors = s.dangerous.count,
          .blocked = s.timid.count,
          .error_m = spread(s.error_m),
          .dangerous = s.dangerous.share(),
          .timid = s.timid.share(),
          .coverage = s.coverage.share(),
          .state_free = s.state_free.share(),
          .free_range_relative = quantile(s.range_relative, .5)};
}

std::vector<std::string> notes_of(const Samples& s) {
  std::vector<std::string> out;
  const auto note = [&](const Tally& tally, const char* text) {
    if (tally.held > 0) out.push_back(std::to_string(tally.held) + " " + text);
  };
  note(s.missing, "frames without a scene line, counted as nothing seen");
  note(s.time_differs, "scene lines whose t is more than 10 ms off the capture time");
  note(s.unscored_missing, "scene lines without lines or why, which are not scored");
  note(s.ball.without_floor, "best balls without a floor position");
  note(s.robot.without_floor, "robots without a floor position");
  note(s.ball.inconsistent, "best balls whose distance is not hypot(x, y)");
  note(s.robot.inconsistent, "robots whose distance is not hypot(x, y)");
  note(s.pose.bad_covariance, "poses whose cov is not positive definite");
  note(s.ball.bad_covariance, "true best balls whose cov is null or not positive definite");
  return out;
}

}  // namespace

void add_sequence(Samples& samples, const std::map<std::int64_t, TrueFrame>& truth,
                  const std::map<std::int64_t, ReportedScene>& scenes, const std::optional<TrueField>& field) {
  std::vector<PoseStep> steps;
  for (const auto& [number, frame] : truth) {
    const auto found = scenes.find(number);
    const ReportedScene* scene = found == scenes.end() ? nullptr : &found->second;
    samples.missing.add(!scene);
    const bool good = add_pose(samples.pose, frame, scene);
    const bool there = scene && scene->pose;
    steps.push_back({there && !scene->pose->mirror, there && scene->pose->predicted, good});
    add_ball(samples.ball, frame.ball, scene);
    add_goal(samples.yellow, GoalName::yellow, frame.goals[0], scene);
    add_goal(samples.blue, GoalName::blue, frame.goals[1], scene);
    add_robots(samples.robot, frame.robots, scene);
    if (field) {
      const ReportedFreeSpace* free = scene && scene->free_space ? &*scene->free_space : nullptr;
      add_coverage(samples.free_space, frame, free);
      const TrueObstacles obstacles(*field, frame);
      for (std::size_t i = 0; free && i < free->ranges.size(); ++i) add_sector(samples.free_space, obstacles, *free, i);
    }
    if (!scene) continue;
    samples.time_differs.add(std::abs(scene->t - frame.t) > .01);
    samples.unscored_missing.add(!scene->has_unscored);
    for (const auto& [stage, ms] : scene->timing_ms) samples.timing_ms[stage].push_back(ms);
  }
  add_fix(samples.pose, steps);
}

SequenceScore summarize(const Samples& s) {
  SequenceScore out{.frames = s.missing.count,
                    .frames_missing = s.missing.held,
                    .pose = summary_of(s.pose),
                    .ball = summary_of(s.ball),
                    .yellow = summary_of(s.yellow),
                    .blue = summary_of(s.blue),
                    .goals = summary_of(s.yellow + s.blue),
                    .robots = summary_of(s.robot),
                    .free_space = summary_of(s.free_space),
                    .timing_ms = {},
                    .notes = notes_of(s)};
  for (const auto& [stage, ms] : s.timing_ms) out.timing_ms[stage] = {quantile(ms, .5), quantile(ms, .99), maximum(ms)};
  return out;
}

}  // namespace tassilo
