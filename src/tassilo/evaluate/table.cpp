#include <algorithm>
#include <array>
#include <cstdint>

#include "tassilo/color/color_class.h"
#include "tassilo/evaluate/evaluate.h"
#include "tassilo/evaluate/internal/figures.h"
#include "tassilo/evaluate/internal/text_table.h"

namespace tassilo {
namespace {

std::string sequence_text(const SequenceScore& s) {
  Columns out;
  for (const FigureGroup& group : figure_groups(s)) {
    if (!group.none.empty()) {
      out.add({group.subject, group.none, "", group.none_reason});
      continue;
    }
    for (const Figure& figure : group.figures)
      out.add(
          {&figure == group.figures.data() ? group.subject : "", figure.name, figure.text(figure.value), figure.rest});
  }
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
