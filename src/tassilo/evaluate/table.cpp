#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <string_view>

#include "tassilo/base/unsigned_zero.h"
#include "tassilo/color/color_class.h"
#include "tassilo/evaluate/evaluate.h"

namespace tassilo {
namespace {

std::string fixed(std::optional<double> value, int digits) {
  if (!value) return "-";
  std::array<char, 400> text;  // the longest double has 309 digits before the point
  const int length = std::snprintf(text.data(), text.size(), "%.*f", digits, *value);
  return unsigned_zero(std::string(text.data(), static_cast<std::size_t>(length)));
}
std::string with_unit(const std::string& number, const char* unit) { return number == "-" ? number : number + unit; }
std::string percent(std::optional<double> share) {
  return with_unit(fixed(share ? std::optional(100 * *share) : share, 1), " %");
}
std::string metres(std::optional<double> value) { return with_unit(fixed(value, 3), " m"); }
std::string degrees_text(std::optional<double> value) { return with_unit(fixed(value, 2), " deg"); }
std::string of(std::int64_t count, const char* what) { return "of " + std::to_string(count) + " " + what; }

/// Characters a person sees: bytes of UTF-8 that begin one.
std::size_t shown_width(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](unsigned char c) { return (c & 0xC0) != 0x80; }));
}
std::string padded(const std::string& text, std::size_t width, bool right = false) {
  const std::size_t seen = shown_width(text);
  const std::string fill(seen < width ? width - seen : 0, ' ');
  return right ? fill + text : text + fill;
}

/// Rows of cells in columns; those of [right_from, right_to) are aligned right.
class Columns {
 public:
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  std::string text(std::size_t right_from, std::size_t right_to) const {
    std::vector<std::size_t> widths;
    for (const auto& row : rows_) {
      widths.resize(std::max(widths.size(), row.size()));
      for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], shown_width(row[i]));
    }
    std::string out;
    for (const auto& row : rows_) {
      std::string line;
      for (std::size_t i = 0; i < row.size(); ++i)
        line += (i ? "  " : "") + padded(row[i], widths[i], i >= right_from && i < right_to);
      line.erase(line.find_last_not_of(' ') + 1);
      out += line + "\n";
    }
    return out;
  }

 private:
  std::vector<std::vector<std::string>> rows_;
};
constexpr std::size_t kToTheEnd = SIZE_MAX;

std::string rest_of(const Spread& s, auto text) {
  return s.count == 0 ? "" : "median; 90 % below " + text(s.p90) + ", at most " + text(s.max);
}

void add_pose(Columns& out, const PoseScore& s, std::int64_t frames) {
  out.add({"pose", "known", percent(s.share), of(frames, "frames")});
  out.add({"", "after the first fix", percent(s.share_after_fix),
           "first fix at frame " + fixed(s.first_fix, 0) +
               (s.never_fixed ? ", sequences never fixed: " + std::to_string(s.never_fixed) : "")});
  out.add({"", "good: 0.10 m, 3 deg", percent(s.good),
           "or point-mirrored " + percent(s.good_mirrored) + ", after the first fix " + percent(s.good_after_fix)});
  out.add({"", "wrong: 0.5 m or 15 deg", percent(s.wrong), "of the poses; marked mirror " + percent(s.mirror)});
  out.add({"", "position error", metres(s.position_m.median), rest_of(s.position_m, metres)});
  out.add({"", "heading error", degrees_text(s.heading_deg.median), rest_of(s.heading_deg, degrees_text)});
  out.add({"", "normalized squared error", fixed(s.nees_mean, 2),
           "mean, 3 is exact; median " + fixed(s.nees_median, 2) + ", 2.37 is exact"});
}

void add_ball(Columns& out, const BallScore& s) {
  out.add({"ball", "recall", percent(s.recall_best), of(s.frames, "frames; in any place ") + percent(s.recall_any)});
  out.add({"", "precision", percent(s.precision_best),
           of(s.reported_best, "best balls; all ") + percent(s.precision_all) + " " + of(s.reported, "balls")});
  out.add({"", "position error", metres(s.error_m.median), rest_of(s.error_m, metres)});
  out.add({"", "relative to distance", percent(s.error_relative.median), rest_of(s.error_relative, percent)});
  out.add({"", "distance within near..far", percent(s.bracketed),
           "median width " + percent(s.bracket_width_relative) + " of the distance"});
  out.add({"", "normalized squared error", fixed(s.nees_mean, 2), "mean, 2 is exact"});
}

void add_goal(Columns& out, const char* title, const GoalScore& s) {
  out.add({title, "recall", percent(s.recall), of(s.frames, "goals")});
  out.add({"", "precision", percent(s.precision), of(s.reported, "reported")});
  out.add({"", "bearing error", degrees_text(s.bearing_deg.median), rest_of(s.bearing_deg, degrees_text)});
}

void add_robots(Columns& out, const RobotScore& s) {
  out.add({"robots", "recall", percent(s.recall), of(s.robots, "robots")});
  out.add({"", "precision", percent(s.precision), of(s.reported, "reported")});
  out.add({"", "team right", percent(s.team_right), "the other team " + percent(s.team_swapped)});
  out.add({"", "nearest point error", metres(s.to_nearest_m.median), rest_of(s.to_nearest_m, metres)});
  out.add({"", "center error", metres(s.center_m.median), rest_of(s.center_m, metres)});
  out.add({"", "distance within near..far", percent(s.bracketed), "median width " + metres(s.bracket_width_m)});
}

void add_free_space(Columns& out, const FreeSpaceScore& s) {
  if (s.sectors == 0 && !s.coverage) {
    out.add({"free space", "not judged", "", "needs meta.json with the field, and sectors"});
    return;
  }
  out.add({"free space", "dangerous sectors", percent(s.dangerous), of(s.sectors, "sectors")});
  out.add({"", "timid sectors", percent(s.timid), of(s.blocked, "blocked sectors")});
  out.add({"", "coverage", percent(s.coverage), "of obstacle feet in view"});
  out.add({"", "range error", metres(s.error_m.median), rest_of(s.error_m, metres)});
  out.add({"", "not ended by an obstacle", percent(s.state_free),
           "of the sectors; their range " + percent(s.free_range_relative) + " of the truth"});
}

/// Stages in the order they run, unknown ones before the total.
std::vector<std::string> stages_in_order(const std::map<std::string, StageTimes>& timing) {
  constexpr std::array<std::string_view, 5> known{"decode", "segment", "detect", "localize", "total"};
  const auto rank = [&](std::string_view stage) {
    const auto at = std::ranges::find(known, stage);
    return at == known.end() ? 7 : 2 * (at - known.begin());
  };
  std::vector<std::string> out;
  for (const auto& [stage, ms] : timing) out.push_back(stage);
  std::ranges::stable_sort(out, {}, rank);
  return out;
}

void add_timing(Columns& out, const std::map<std::string, StageTimes>& timing) {
  const char* title = "time";
  for (const std::string& stage : stages_in_order(timing)) {
    const StageTimes& ms = timing.at(stage);
    out.add({title, stage, with_unit(fixed(ms.median, 2), " ms"),
             "median; 99 % below " + with_unit(fixed(ms.p99, 2), " ms")});
    title = "";
  }
}

std::string sequence_text(const SequenceScore& s) {
  Columns out;
  // A run that never tells a pose was not asked for one: seven rows of failure would hide the rest.
  if (s.pose.share.value_or(0) > 0)
    add_pose(out, s.pose, s.frames);
  else
    out.add({"pose", "none in these scenes", "", ""});
  add_ball(out, s.ball);
  add_goal(out, "yellow goal", s.yellow);
  add_goal(out, "blue goal", s.blue);
  add_goal(out, "both goals", s.goals);
  add_robots(out, s.robots);
  add_free_space(out, s.free_space);
  add_timing(out, s.timing_ms);
  std::string text = std::to_string(s.frames) + " frames\n" + out.text(2, 3);
  for (const std::string& note : s.notes) text += "note: " + note + "\n";
  return text;
}

std::string short_percent(std::optional<double> share) { return fixed(share ? std::optional(100 * *share) : share, 1); }
std::string recall_precision(std::optional<double> recall, std::optional<double> precision) {
  return short_percent(recall) + "/" + short_percent(precision);
}

void add_row(Columns& out, const std::string& name, const SequenceScore& s) {
  const auto total = s.timing_ms.find("total");
  out.add({name, std::to_string(s.frames), short_percent(s.pose.good),
           recall_precision(s.ball.recall_best, s.ball.precision_best), short_percent(s.ball.error_relative.median),
           short_percent(s.ball.bracketed), recall_precision(s.goals.recall, s.goals.precision),
           fixed(s.goals.bearing_deg.median, 2), recall_precision(s.robots.recall, s.robots.precision),
           short_percent(s.robots.team_right), fixed(s.robots.to_nearest_m.median, 3),
           short_percent(s.robots.bracketed), short_percent(s.free_space.dangerous), short_percent(s.free_space.timid),
           short_percent(s.free_space.coverage), total == s.timing_ms.end() ? "-" : fixed(total->second.median, 2)});
}

std::string rows_text(const Evaluation& evaluation) {
  Columns out;
  out.add({"", "frames", "pose", "ball", "", "", "goals", "", "robots", "", "", "", "free", "", "", "time"});
  out.add({"", "", "good", "r/p", "error", "within", "r/p", "deg", "r/p", "team", "m", "within", "danger", "timid",
           "cover", "ms"});
  for (const auto& [name, score] : evaluation.sequences) add_row(out, name, score);
  add_row(out, "all", *evaluation.overall);
  return out.text(1, kToTheEnd) +
         "shares in %; r/p: recall/precision; error: of the distance; m: nearest point; within: distance within "
         "near..far\n";
}

std::string class_name(std::size_t label) { return std::string(to_string(static_cast<ColorClass>(label))); }

/// What a class is mostly taken for, at most three others.
std::string mistakes(const std::array<std::int64_t, 9>& found, std::size_t label, std::int64_t pixels) {
  std::vector<std::size_t> others;
  for (std::size_t k = 0; k < found.size(); ++k)
    if (k != label && found[k] > 0) others.push_back(k);
  std::ranges::stable_sort(others, std::ranges::greater(), [&](std::size_t k) { return found[k]; });
  others.resize(std::min<std::size_t>(others.size(), 3));
  std::string out;
  for (const std::size_t k : others)
    out += (out.empty() ? "" : ", ") + class_name(k) + " " +
           percent(static_cast<double>(found[k]) / static_cast<double>(pixels));
  return out;
}

std::string colors_text(const Evaluation& evaluation) {
  std::string text;
  if (evaluation.color_sets.size() > 1) {
    Columns rows;
    std::vector<std::string> head{"colors, recall/precision %"};
    for (std::size_t k = 0; k < 9; ++k) head.push_back(class_name(k));
    head.push_back("mean");
    rows.add(std::move(head));
    for (const auto& [name, s] : evaluation.color_sets) {
      std::vector<std::string> row{name};
      for (const auto& c : s.classes) row.push_back(recall_precision(c.recall, c.precision));
      row.push_back(recall_precision(s.mean_recall, s.mean_precision));
      rows.add(std::move(row));
    }
    text += rows.text(1, kToTheEnd);
  }
  const ColorScore& all = *evaluation.colors;
  Columns out;
  out.add({"colors", "pixels", "recall", "precision", "taken for"});
  for (std::size_t k = 0; k < all.classes.size(); ++k) {
    const auto& c = all.classes[k];
    out.add({class_name(k), std::to_string(c.pixels), percent(c.recall), percent(c.precision),
             mistakes(all.confusion[k], k, c.pixels)});
  }
  out.add({"mean of " + std::to_string(all.mean_over), "", percent(all.mean_recall), percent(all.mean_precision),
           "accuracy " + percent(all.accuracy) + ", " + std::to_string(all.maps) + " label maps" +
               (all.missing ? ", missing: " + std::to_string(all.missing) : "")});
  return text + out.text(1, 4);
}

std::string place_text(const BallImageScore::Place& place) {
  std::string out = place.image + "  [";
  for (std::size_t i = 0; i < place.box.size(); ++i) out += (i ? ", " : "") + fixed(place.box[i], 0);
  return out + "]";
}

std::string balls_text(const BallImageScore& s) {
  Columns out;
  out.add({"single images", "balls found", percent(s.recall_any),
           of(s.balls, "balls in ") + std::to_string(s.images) + " images; excluded: " + std::to_string(s.excluded)});
  out.add({"", "images, best ball", percent(s.recall_best), "of the images with a ball"});
  out.add({"", "precision", percent(s.precision_best),
           of(s.reported_best, "best balls; all ") + percent(s.precision_all) + " " + of(s.reported, "balls")});
  out.add({"", "missed", std::to_string(s.missed.size()), ""});
  out.add({"", "false", std::to_string(s.wrong.size()), ""});
  std::string text = out.text(2, 3);
  for (const auto& place : s.missed) text += "missed: " + place_text(place) + "\n";
  for (const auto& place : s.wrong) text += (place.best ? "false, as best: " : "false: ") + place_text(place) + "\n";
  for (const std::string& image : s.missing) text += "note: no scene line for " + image + ", counted as nothing seen\n";
  for (const std::string& image : s.unknown) text += "note: no truth for " + image + ", not counted\n";
  return text;
}

std::string poses_text(const Named<PoseImageScore>& poses) {
  Columns out;
  out.add({"poses in single images", "images", "with pose", "draws", "poses", "m", "90 %", "deg", "90 %", "wrong"});
  for (const auto& [quality, s] : poses)
    out.add({quality, std::to_string(s.images), std::to_string(s.images_with_pose), std::to_string(s.draws),
             std::to_string(s.poses), fixed(s.position_m.median, 3), fixed(s.position_m.p90, 3),
             fixed(s.heading_deg.median, 2), fixed(s.heading_deg.p90, 2), percent(s.wrong)});
  return out.text(1, kToTheEnd);
}

}  // namespace

std::string table(const Evaluation& evaluation) {
  std::vector<std::string> parts;
  if (evaluation.sequences.size() > 1) parts.push_back(rows_text(evaluation));
  if (evaluation.overall) parts.push_back(sequence_text(*evaluation.overall));
  if (evaluation.colors) parts.push_back(colors_text(evaluation));
  if (evaluation.balls) parts.push_back(balls_text(*evaluation.balls));
  if (!evaluation.poses.empty()) parts.push_back(poses_text(evaluation.poses));
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "\n") + part;
  return text;
}

}  // namespace tassilo
