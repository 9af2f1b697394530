#include "tassilo/app/run_summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>

#include "tassilo/base/median.h"

namespace tassilo {
namespace {

/// Of a run without end the last two hours.
void keep(std::vector<double>& values, double value, std::int64_t count) {
  constexpr std::size_t most = 200'000;
  if (values.size() < most)
    values.push_back(value);
  else
    values[static_cast<std::size_t>(count) % most] = value;
}

/// "1 frame", "2 frames".
std::string counted(std::int64_t count, std::string_view thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

}  // namespace

RunSummary::Count& RunSummary::count_of(const std::string& kind) {
  const auto it = std::ranges::find(seen_, kind, &std::pair<std::string, Count>::first);
  return it != seen_.end() ? it->second : seen_.emplace_back(kind, Count{}).second;
}

void RunSummary::add(const Scene& scene) {
  // A source that is played again begins to count again.
  if (frames_ > 0 && scene.frame > last_index_) dropped_ += scene.frame - last_index_ - 1;
  last_index_ = scene.frame;
  ++frames_;
  const auto count = [&](const std::string& kind, std::size_t objects) {
    Count& total = count_of(kind);
    total.frames += objects > 0;
    total.objects += static_cast<std::int64_t>(objects);
  };
  const auto goals = [&](GoalColor color) {
    return static_cast<std::size_t>(std::ranges::count(scene.goals, color, &Goal::color));
  };
  const auto robots = [&](Team team) {
    return static_cast<std::size_t>(std::ranges::count(scene.robots, team, &RobotSeen::team));
  };
  count("ball", scene.balls.size());
  count("yellow goal", goals(GoalColor::yellow));
  count("blue goal", goals(GoalColor::blue));
  count("cyan robot", robots(Team::cyan));
  count("magenta robot", robots(Team::magenta));
  count("other robot", robots(Team::unknown));
  count("line", scene.lines.size());
  count("center circle", scene.circles.size());
  for (const StageTime& time : scene.timing) {
    auto it = std::ranges::find(times_, time.stage, &std::pair<std::string, std::vector<double>>::first);
    if (it == times_.end()) it = times_.insert(times_.end(), {time.stage, {}});
    keep(it->second, time.ms, frames_);
  }
}

void RunSummary::add_latency(double ms) { keep(latencies_ms_, ms, frames_); }

/// "odometry: 118 of 120 frames, 2 missing; 3 samples out of order, 1 duplicate sample", without what is zero.
std::string RunSummary::odometry_text() const {
  const std::int64_t frames = odometry_known_ + odometry_missing_;
  if (frames == 0) return "";
  std::string out = fmt::format("odometry: {} of {}", odometry_known_, counted(frames, "frame"));
  if (odometry_missing_ > 0) out += fmt::format(", {} missing", odometry_missing_);
  if (odometry_known_ == 0) out += ": is it on the clock of the frames?";
  const char* separator = "; ";
  const auto samples = [&](std::int64_t count, std::string_view before, std::string_view after) {
    if (count == 0) return;
    out +=
        fmt::format("{}{}{}", std::exchange(separator, ", "), counted(count, fmt::format("{}sample", before)), after);
  };
  samples(odometry_samples_.out_of_order, "", " out of order");
  samples(odometry_samples_.duplicates, "duplicate ", "");
  samples(odometry_samples_.too_late, "", " too late");
  return out + "\n";
}

std::string RunSummary::text(double seconds, const std::string& source) const {
  std::string out = fmt::format("\n{} frames in {:.2f} s", frames_, seconds);
  if (frames_ > 0 && seconds > 0) out += fmt::format(", {:.1f} frames/s", static_cast<double>(frames_) / seconds);
  out += fmt::format(", {} dropped\n", dropped_);
  out += source + odometry_text();
  if (!drift_.empty())
    out += fmt::format("mount: has drifted from the camera file: {}; `tassilo calibrate mount` measures it\n", drift_);
  if (frames_ == 0) return out;
  if (!latencies_ms_.empty())
    out += fmt::format("latency from capture to scene: median {:.1f} ms, p99 {:.1f} ms\n", quantile(latencies_ms_, 0.5),
                       quantile(latencies_ms_, 0.99));
  out += fmt::format("\n{:16}{:>10}{:>10}\n", "seen", "frames", "objects");
  for (const auto& [kind, count] : seen_) out += fmt::format("{:16}{:>10}{:>10}\n", kind, count.frames, count.objects);
  out += fmt::format("\n{:16}{:>10}{:>10}\n", "stage", "median ms", "p99 ms");
  for (const auto& [stage, ms] : times_)
    out += fmt::format("{:16}{:>10.3f}{:>10.3f}\n", stage, quantile(ms, 0.5), quantile(ms, 0.99));
  return out;
}

}  // namespace tassilo
