#include "tassilo/evaluate/internal/figures.h"

#include <algorithm>
#include <array>
#include <utility>

#include "tassilo/evaluate/internal/text_table.h"

namespace tassilo {
namespace {

std::string two_digits(std::optional<double> value) { return fixed(value, 2); }

Figure share(std::string name, std::optional<double> value, Better better, std::string rest) {
  return {std::move(name), value, percent, better, std::move(rest), nullptr};
}
Figure median_of(std::string name, const Spread& spread, std::string (*text)(std::optional<double>)) {
  return {std::move(name), spread.median, text, Better::lower, rest_of(spread, text), &spread};
}
/// Which value is best is known, but not whether too much is worse than too little.
Figure squared_error(std::optional<double> value, std::string rest) {
  return {"normalized squared error", value, two_digits, Better::unknown, std::move(rest), nullptr};
}

FigureGroup pose_figures(const PoseScore& s, std::int64_t frames) {
  FigureGroup out{"pose", {}, {}, {}};
  // A run that never tells a pose was not asked for one: seven rows of failure would hide the rest.
  if (!(s.share.value_or(0) > 0)) out.none = "none in these scenes";
  out.figures = {
      share("known", s.share, Better::higher, of(frames, "frames")),
      share("after the first fix", s.share_after_fix, Better::higher,
            "first fix at frame " + fixed(s.first_fix, 0) +
                (s.never_fixed ? ", sequences never fixed: " + std::to_string(s.never_fixed) : "")),
      share("good: 0.10 m, 3 deg", s.good, Better::higher,
            "or point-mirrored " + percent(s.good_mirrored) + ", after the first fix " + percent(s.good_after_fix)),
      share("wrong: 0.5 m or 15 deg", s.wrong, Better::lower, "of the poses; marked mirror " + percent(s.mirror)),
      median_of("position error", s.position_m, metres),
      median_of("heading error", s.heading_deg, degrees_text),
      squared_error(s.nees_mean, "mean, 3 is exact; median " + fixed(s.nees_median, 2) + ", 2.37 is exact")};
  return out;
}

FigureGroup ball_figures(const BallScore& s) {
  return {
      "ball",
      {share("recall", s.recall_best, Better::higher, of(s.frames, "frames; in any place ") + percent(s.recall_any)),
       share("precision", s.precision_best, Better::higher,
             of(s.reported_best, "best balls; all ") + percent(s.precision_all) + " " + of(s.reported, "balls")),
       median_of("position error", s.error_m, metres), median_of("relative to distance", s.error_relative, percent),
       share("distance within near..far", s.bracketed, Better::higher,
             "median width " + percent(s.bracket_width_relative) + " of the distance"),
       squared_error(s.nees_mean, "mean, 2 is exact")},
      {},
      {}};
}

FigureGroup goal_figures(const char* subject, const GoalScore& s) {
  return {subject,
          {share("recall", s.recall, Better::higher, of(s.frames, "goals")),
           share("precision", s.precision, Better::higher, of(s.reported, "reported")),
           median_of("bearing error", s.bearing_deg, degrees_text)},
          {},
          {}};
}

FigureGroup robot_figures(const RobotScore& s) {
  return {
      "robots",
      {share("recall", s.recall, Better::higher, of(s.robots, "robots")),
       share("precision", s.precision, Better::higher, of(s.reported, "reported")),
       share("team right", s.team_right, Better::higher, "the other team " + percent(s.team_swapped)),
       median_of("nearest point error", s.to_nearest_m, metres), median_of("center error", s.center_m, metres),
       share("distance within near..far", s.bracketed, Better::higher, "median width " + metres(s.bracket_width_m))},
      {},
      {}};
}

FigureGroup free_space_figures(const FreeSpaceScore& s) {
  FigureGroup out{"free space", {}, {}, {}};
  if (s.sectors == 0 && !s.coverage) {
    out.none = "not judged";
    out.none_reason = "needs meta.json with the field, and sectors";
  }
  out.figures = {share("dangerous sectors", s.dangerous, Better::lower, of(s.sectors, "sectors")),
                 share("timid sectors", s.timid, Better::lower, of(s.blocked, "blocked sectors")),
                 share("coverage", s.coverage, Better::higher, "of obstacle feet in view"),
                 median_of("range error", s.error_m, metres),
                 share("not ended by an obstacle", s.state_free, Better::unknown,
                       "of the sectors; their range " + percent(s.free_range_relative) + " of the truth")};
  return out;
}

FigureGroup time_figures(const std::map<std::string, StageTimes>& timing) {
  FigureGroup out{"time", {}, {}, {}};
  std::vector<std::string> stages;
  for (const auto& [stage, ms] : timing) stages.push_back(stage);
  for (const std::string& stage : stages_in_order(std::move(stages))) {
    const StageTimes& ms = timing.at(stage);
    out.figures.push_back(
        {stage, ms.median, milliseconds, Better::lower, "median; 99 % below " + milliseconds(ms.p99), nullptr});
  }
  return out;
}

}  // namespace

std::vector<FigureGroup> figure_groups(const SequenceScore& s) {
  return {pose_figures(s.pose, s.frames),        ball_figures(s.ball),
          goal_figures("yellow goal", s.yellow), goal_figures("blue goal", s.blue),
          goal_figures("both goals", s.goals),   robot_figures(s.robots),
          free_space_figures(s.free_space),      time_figures(s.timing_ms)};
}

std::vector<std::string> stages_in_order(std::vector<std::string> stages) {
  constexpr std::array<std::string_view, 5> known{"decode", "segment", "detect", "localize", "total"};
  std::ranges::stable_sort(stages, {}, [&](std::string_view stage) {
    const auto at = std::ranges::find(known, stage);
    return at == known.end() ? 7 : 2 * (at - known.begin());
  });
  return stages;
}

std::string rest_of(const Spread& s, std::string (*text)(std::optional<double>)) {
  return s.count == 0 ? "" : "median; 90 % below " + text(s.p90) + ", at most " + text(s.max);
}

}  // namespace tassilo
