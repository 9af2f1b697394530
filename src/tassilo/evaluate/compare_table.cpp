#include <algorithm>
#include <cmath>

#include "tassilo/evaluate/compare.h"
#include "tassilo/evaluate/internal/figures.h"
#include "tassilo/evaluate/internal/text_table.h"

namespace tassilo {
namespace {

using Text = std::string (*)(std::optional<double>);

std::string count(std::int64_t n) { return std::to_string(n); }

/// "3, 4, 5, and 7 more"; empty where none is to be shown.
std::string first_of(const std::vector<std::int64_t>& frames, int max_rows) {
  const std::size_t shown = std::min(frames.size(), static_cast<std::size_t>(std::max(max_rows, 0)));
  if (shown == 0) return "";
  std::string out;
  for (std::size_t i = 0; i < shown; ++i) out += (i ? ", " : "") + std::to_string(frames[i]);
  if (shown < frames.size()) out += ", and " + std::to_string(frames.size() - shown) + " more";
  return out;
}

std::string frames_text(const Comparison& c, int max_rows) {
  Columns out;
  out.add({"frames", "in both", count(c.frames), ""});
  out.add({"", "equal apart from timing", count(c.equal_frames), c.equal() ? "the runs are equal" : ""});
  out.add({"", "only in A", count(std::ssize(c.only_a)), first_of(c.only_a, max_rows)});
  out.add({"", "only in B", count(std::ssize(c.only_b)), first_of(c.only_b, max_rows)});
  return "A: " + c.name_a + "\nB: " + c.name_b + "\n\n" + out.text(2, 3);
}

std::string subjects_text(const Comparison& c, int max_rows) {
  Columns out;
  out.add({"differs in", "frames", "which"});
  for (const SubjectDifference& s : c.subjects)
    out.add({s.subject, count(std::ssize(s.frames)), first_of(s.frames, max_rows)});
  return out.text(1, 2);
}

std::string alone(const Paired& p) { return "only A " + count(p.only_a) + ", only B " + count(p.only_b); }

// As fine as scene lines are written: what differs at all shows.
std::string fine_metres(std::optional<double> value) { return with_unit(fixed(value, 6), " m"); }
std::string fine_degrees(std::optional<double> value) { return with_unit(fixed(value, 4), " deg"); }
std::string fine_pixels(std::optional<double> value) { return with_unit(fixed(value, 3), " px"); }

void add_spread(Columns& out, const char* name, const Spread& s, Text text) {
  if (s.count > 0) out.add({"", name, text(s.median), rest_of(s, text)});
}

/// How much differs; subjects that are equal in all frames are left out.
std::string differences_text(const Comparison& c) {
  Columns out;
  const auto begin = [&](const std::string& key, const char* things, const Paired& p) {
    const auto subject = std::ranges::find(c.subjects, key, &SubjectDifference::subject);
    if (subject == c.subjects.end() || subject->frames.empty()) return false;
    out.add({key, things, count(p.both), alone(p)});
    return true;
  };
  const auto add_count = [&](const char* name, std::int64_t n, const std::string& rest) {
    if (n > 0) out.add({"", name, count(n), rest});
  };
  if (begin("pose", "known in both", c.pose.frames)) {
    add_spread(out, "distance", c.pose.distance_m, fine_metres);
    add_spread(out, "turn", c.pose.turn_deg, fine_degrees);
    add_count("kind differs", c.pose.kind_differs, "frames");
    add_count("mirror differs", c.pose.mirror_differs, "frames");
  }
  if (begin("balls", "in both", c.balls.balls)) {
    add_spread(out, "distance", c.balls.distance_m, fine_metres);
    add_spread(out, "in the image", c.balls.center_px, fine_pixels);
  }
  if (begin("goals", "in both", c.goals.goals)) {
    add_spread(out, "bearing", c.goals.bearing_deg, fine_degrees);
    add_spread(out, "distance", c.goals.distance_m, fine_metres);
  }
  if (begin("robots", "in both", c.robots.robots)) {
    add_spread(out, "nearest point", c.robots.nearest_m, fine_metres);
    add_spread(out, "center", c.robots.center_m, fine_metres);
    add_count("team differs", c.robots.team_differs, "robots");
  }
  if (begin("lines", "in both", c.lines.lines)) {
    add_spread(out, "ends in the image", c.lines.ends_px, fine_pixels);
    add_count("model differs", c.lines.model_differs, "lines");
    if (c.lines.circles.both + c.lines.circles.only_a + c.lines.circles.only_b > 0)
      out.add({"", "circles in both", count(c.lines.circles.both), alone(c.lines.circles)});
    add_spread(out, "centers of circles", c.lines.center_m, fine_metres);
  }
  if (begin("free_space", "in both", c.free_space.frames)) {
    const FreeSpaceDifference& space = c.free_space;
    add_count("other sectors", space.other_sectors, "frames, not compared");
    if (space.sectors > 0)
      out.add({"", "state differs",
               percent(static_cast<double>(space.state_differs) / static_cast<double>(space.sectors)),
               of(space.sectors, "sectors")});
    add_spread(out, "range", space.range_m, fine_metres);
  }
  return out.text(2, 3);
}

std::string times_text(const Comparison& c) {
  std::vector<std::string> stages;
  for (const auto& [stage, ms] : c.timing_ms_a) stages.push_back(stage);
  for (const auto& [stage, ms] : c.timing_ms_b)
    if (!c.timing_ms_a.contains(stage)) stages.push_back(stage);
  const auto median = [](const std::map<std::string, StageTimes>& timing, const std::string& stage) {
    const auto at = timing.find(stage);
    return at == timing.end() ? std::optional<double>() : at->second.median;
  };
  Columns out;
  out.add({"time, median", "A", "B", "B / A"});
  for (const std::string& stage : stages_in_order(std::move(stages))) {
    const auto a = median(c.timing_ms_a, stage), b = median(c.timing_ms_b, stage);
    out.add({stage, milliseconds(a), milliseconds(b), a && b && *a > 0 ? fixed(*b / *a, 2) : "-"});
  }
  return out.text(1, kToTheEnd);
}

/// B - A with its sign, as `text` shows values; "-" where one is missing.
std::string difference_text(std::optional<double> a, std::optional<double> b, Text text) {
  if (!a || !b) return "-";
  const std::string out = text(*b - *a);
  return *b - *a > 0 && out.find_first_of("123456789") != std::string::npos ? "+" + out : out;
}

/// "A" or "B"; nothing where that is not known, or nobody sees a difference.
std::string better_text(const Figure& a, const Figure& b) {
  if (a.better == Better::unknown || !a.value || !b.value || a.text(a.value) == b.text(b.value)) return "";
  return (*a.value > *b.value) == (a.better == Better::higher) ? "A" : "B";
}

void add_figures(Columns& out, const std::string& subject, const Figure& a, const Figure& b) {
  out.add({subject, a.name, a.text(a.value), b.text(b.value), difference_text(a.value, b.value, a.text),
           better_text(a, b)});
  if (a.spread == nullptr || b.spread == nullptr || a.spread->count + b.spread->count == 0) return;
  Figure tail_a{"  90 % below", a.spread->p90, a.text, a.better, {}, nullptr}, tail_b = tail_a;
  tail_b.value = b.spread->p90;
  add_figures(out, "", tail_a, tail_b);
}

/// Both against the truth, the same rows as for one.
std::string truth_text(const SequenceScore& a, const SequenceScore& b) {
  Columns out;
  out.add({"against the truth", count(a.frames) + " frames", "A", "B", "B - A", "better"});
  out.add({"", "without a scene line", count(a.frames_missing), count(b.frames_missing),
           difference_text(static_cast<double>(a.frames_missing), static_cast<double>(b.frames_missing),
                           [](std::optional<double> n) { return fixed(n, 0); }),
           ""});
  const std::vector<FigureGroup> groups_a = figure_groups(a), groups_b = figure_groups(b);
  for (std::size_t g = 0; g < groups_a.size(); ++g) {
    const FigureGroup &one = groups_a[g], &other = groups_b[g];
    if (one.subject == "time") continue;  // told already, and needs no truth
    if (!one.none.empty() && !other.none.empty()) {
      out.add({one.subject, one.none});
      continue;
    }
    for (std::size_t i = 0; i < one.figures.size(); ++i)
      add_figures(out, i == 0 ? one.subject : "", one.figures[i], other.figures[i]);
  }
  std::string text = out.text(2, 5);
  for (const std::string& note : a.notes) text += "note: A: " + note + "\n";
  for (const std::string& note : b.notes) text += "note: B: " + note + "\n";
  return text;
}

}  // namespace

std::string table(const Comparison& c, int max_rows) {
  std::vector<std::string> parts{frames_text(c, max_rows), subjects_text(c, max_rows), differences_text(c),
                                 times_text(c)};
  if (c.truth_a && c.truth_b) parts.push_back(truth_text(*c.truth_a->overall, *c.truth_b->overall));
  std::string text;
  for (const std::string& part : parts)
    if (!part.empty()) text.append(text.empty() ? "" : "\n").append(part);
  return text;
}

}  // namespace tassilo
