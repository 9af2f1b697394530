#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tassilo/app/bus_arguments.h"
#include "tassilo/app/commands.h"
#include "tassilo/app/monitor.h"
#include "tassilo/app/signals.h"
#include "tassilo/app/sim_match.h"
#include "tassilo/app/web_arguments.h"
#include "tassilo/base/error.h"
#include "tassilo/base/median.h"
#include "tassilo/files/field_file.h"

namespace tassilo {
namespace {

struct DemoArguments {
  SimMatchOptions match;
  WebArguments web;
  BusArguments bus;
  std::string field = "msl98", own_goal = "yellow", record;
  std::optional<double> duration;
  bool is_headless = false, reports = false, quiet = false;
};

using Clock = std::chrono::steady_clock;

std::string error_line(const char* what, const std::vector<double>& errors) {
  if (errors.empty()) return fmt::format("{:<22}  never\n", what);
  return fmt::format("{:<22} {:>7} {:>9.1f} {:>8.1f}\n", what, errors.size(), 100 * quantile(errors, 0.5),
                     100 * quantile(errors, 0.9));
}

void print_report(const SimMatch& match) {
  const SimMatchReport& report = match.report();
  fmt::print("\nagainst the truth        values median cm    90 % cm\n");
  fmt::print("{}", error_line("ball, each robot", report.ball_errors));
  fmt::print("{}", error_line("pose", report.pose_errors));
  fmt::print("{}", error_line("ball, team", report.team_errors));
  fmt::print("{}", error_line("ball, surest robot", report.best_errors));
  if (report.seen > 0)
    fmt::print("team ball known in {:.1f} % of the {} moments in which a robot saw it\n",
               100. * static_cast<double>(report.known) / static_cast<double>(report.seen), report.seen);
  if (!report.nees.empty())
    fmt::print("squared error by covariance: {:.2f} in the mean; 2 is right\n",
               std::accumulate(report.nees.begin(), report.nees.end(), 0.) / static_cast<double>(report.nees.size()));
  fmt::print("longest time without a pose within half a metre: {:.1f} s\n", report.longest_lost);
}

GoalSide side_of(const FieldModel& field, const std::string& color) {
  const auto side = side_of_goal(field, color == to_string(GoalColor::blue) ? GoalColor::blue : GoalColor::yellow);
  if (!side) throw Error("--own-goal", "is " + color + ", but the field has no such goal");
  return *side;
}

/// Plays until it is time; in real time unless headless.
void play(SimMatch& match, const DemoArguments& arguments) {
  const auto begin = Clock::now();
  std::size_t called = 0;
  while (!is_interrupted() && (!arguments.duration || match.t() < *arguments.duration)) {
    match.step();
    for (; called < match.calls().size(); ++called) {
      const RefereeEvent& event = match.calls()[called];
      if (arguments.quiet || event.call == RefereeCall::kick_off) continue;
      fmt::print("{:7.1f} s  {}{}   {} : {}\n", event.t, to_string(event.call),
                 event.call == RefereeCall::goal ? fmt::format(" for {}", to_string(event.team)) : "",
                 match.score().cyan, match.score().magenta);
      std::fflush(stdout);
    }
    for (const std::string& line : match.news()) fmt::print("{}\n", line);
    if (!arguments.is_headless)
      std::this_thread::sleep_until(
          begin + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(match.t())));
  }
  if (arguments.quiet) return;
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  fmt::print("\n{:.1f} s played in {:.1f} s; {:.1f} images a second and robot; cyan {} : {} magenta\n", match.t(),
             seconds, static_cast<double>(match.report().images) / arguments.match.robots / std::max(seconds, 1e-9),
             match.score().cyan, match.score().magenta);
}

int demo(const DemoArguments& arguments) {
  end_cleanly_on_signals();
  SimMatchOptions options = arguments.match;
  options.field = read_field(arguments.field);
  options.cyan_own_goal = side_of(options.field, arguments.own_goal);
  if (!arguments.is_headless) options.bus = arguments.bus.options();
  if (!arguments.quiet) {
    fmt::print("training the colors on rendered stills\n");
    std::fflush(stdout);
  }
  SimMatch match(options);
  if (!arguments.quiet)
    fmt::print("{:.2f} % of their pixels are classified right by the others\n", 100 * match.colors_quality());
  if (arguments.is_headless) {
    play(match, arguments);
  } else {
    MonitorOptions monitor;
    monitor.field = options.field;
    monitor.bus = *options.bus;
    monitor.web = arguments.web.options();
    monitor.record = arguments.record;
    LiveMonitor live(monitor);
    tell_address(monitor.web, live.url());
    std::atomic<bool> is_over = false;
    std::optional<Error> trouble;
    std::thread listener([&] {
      try {
        live.run([&] { return is_over.load(); });
      } catch (const Error& error) {
        trouble = error;
      }
    });
    play(match, arguments);
    is_over = true;
    listener.join();
    if (trouble) throw *trouble;
  }
  if (arguments.reports) print_report(match);
  return 0;
}

}  // namespace

Command add_demo(CLI::App& program) {
  auto* command = program.add_subcommand("demo",
                                         "a simulated match: cyan plays by what its rendered cameras show, with colors "
                                         "trained on stills of this hall, shown "
                                         "by the monitor");
  auto arguments = std::make_shared<DemoArguments>();
  command->add_option("--field", arguments->field, "field: a shipped name or a path")->capture_default_str();
  command->add_option("--robots", arguments->match.robots, "robots a team")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  command->add_option("--own-goal", arguments->own_goal, "the goal that cyan defends")
      ->check(CLI::IsMember({"yellow", "blue"}))
      ->capture_default_str();
  command->add_option("--fps", arguments->match.frame_rate, "images a second of each robot")
      ->check(CLI::Range(5, 60))
      ->capture_default_str();
  command->add_option("--seed", arguments->match.seed, "another match")->capture_default_str();
  command->add_option("--loss", arguments->match.loss, "share of what robots tell each other that is lost")
      ->check(CLI::Range(0., 0.95))
      ->capture_default_str();
  command->add_option("--delay", arguments->match.delay_s, "how long the rest takes, in the mean [s]")
      ->check(CLI::Range(0., 1.))
      ->capture_default_str();
  command->add_flag("--dark", arguments->match.is_dark, "cyan's cameras show black");
  command->add_option("--duration", arguments->duration, "end after so many seconds of play (default: Ctrl-C)")
      ->check(CLI::PositiveNumber);
  auto* headless = command->add_flag("--headless", arguments->is_headless,
                                     "without bus and monitor, as fast as it goes; needs --duration");
  command->add_flag("--report", arguments->reports, "compare what was seen and known with the truth, at the end");
  command->add_option("--record", arguments->record, "write all that is told into this log, NAME.mcap")
      ->excludes(headless);
  command->add_flag("-q,--quiet", arguments->quiet, "print nothing but the report and errors");
  arguments->bus.add_to(*command);
  arguments->web.add_to(*command);
  command->callback([arguments] {
    if (arguments->is_headless && !arguments->duration)
      throw CLI::ValidationError("--headless", "would never end, --duration is missing");
  });
  return [arguments] { return demo(*arguments); };
}

}  // namespace tassilo
