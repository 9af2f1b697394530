#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tassilo/app/bus_arguments.h"
#include "tassilo/app/commands.h"
#include "tassilo/app/monitor.h"
#include "tassilo/app/signals.h"
#include "tassilo/app/sim_match.h"
#include "tassilo/app/web_arguments.h"
#include "tassilo/base/error.h"
#include "tassilo/files/field_file.h"

namespace tassilo {
namespace {

struct DemoArguments {
  SimMatchOptions match;
  WebArguments web;
  BusArguments bus;
  std::string field = "msl98", own_goal, record;
  std::optional<double> duration;
  double speed = 1, memory_s = MonitorOptions{}.memory_s;
  bool is_headless = false, reports = false, compares_radios = false, quiet = false;
};

using Clock = std::chrono::steady_clock;

/// Of the goal of a color; where none is asked for, of the yellow one, or the left end of a field that has none.
GoalSide side_of(const FieldModel& field, const std::string& color) {
  const auto side = side_of_goal(field, color == to_string(GoalColor::blue) ? GoalColor::blue : GoalColor::yellow);
  if (!side && !color.empty()) throw Error("--own-goal", "is " + color + ", but the field has no such goal");
  return side.value_or(GoalSide::minus_x);
}

/// What the referee calls, for people.
const char* words_of(RefereeCall call) {
  switch (call) {
    case RefereeCall::kick_off:
      return "kick-off";
    case RefereeCall::goal:
      return "goal";
    case RefereeCall::ball_out:
      return "ball out, put back";
    case RefereeCall::stuck_ball:
      return "ball stuck, put elsewhere";
  }
  return "";
}

bool is_paced(const DemoArguments& arguments) { return !arguments.is_headless && arguments.speed > 0; }

/// Listens beside the match, to its end.
class Beside {
 public:
  explicit Beside(LiveMonitor& monitor) : thread_([this, &monitor] { listen(monitor); }) {}
  ~Beside() { end(); }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;
  bool has_failed() const { return has_failed_; }
  /// Throws what it failed of.
  void finish() {
    end();
    if (trouble_) std::rethrow_exception(trouble_);
  }

 private:
  void end() {
    is_over_ = true;
    if (thread_.joinable()) thread_.join();
  }
  void listen(LiveMonitor& monitor) {
    try {
      monitor.run([&] { return is_over_.load(); });
    } catch (...) {
      trouble_ = std::current_exception();
      has_failed_ = true;
    }
  }
  std::atomic<bool> is_over_ = false, has_failed_ = false;
  std::exception_ptr trouble_;
  std::thread thread_;  // the last: it uses the others
};

/// Plays until it is time, or `is_over` says so.
void play(SimMatch& match, const DemoArguments& arguments, const std::function<bool()>& is_over) {
  const auto begin = Clock::now();
  auto next = begin;
  // Who cannot look at a clock is told how far it is.
  const double told_every = std::min(60., arguments.duration.value_or(600) / 10);
  double next_told = is_paced(arguments) || arguments.quiet ? 1e18 : told_every;
  while (!is_over() && (!arguments.duration || match.t() < *arguments.duration)) {
    const double t = match.t();
    match.step();
    for (const RefereeEvent& event : match.take_calls()) {
      if (arguments.quiet || event.call == RefereeCall::kick_off) continue;
      fmt::print("{:7.1f} s  {}{}   {} : {}\n", event.t, words_of(event.call),
                 event.call == RefereeCall::goal ? fmt::format(" for {}", to_string(event.team)) : "",
                 match.score().cyan, match.score().magenta);
    }
    if (match.t() >= next_told) {
      next_told += told_every;
      fmt::print("{:7.1f} s  played\n", match.t());
    }
    for (const std::string& line : match.news()) fmt::print("{}\n", line);
    std::fflush(stdout);
    if (!is_paced(arguments)) continue;
    next +=
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>((match.t() - t) / arguments.speed));
    // Time that was lost, by a slow machine or a stopped process, is not made up for.
    next = std::max(next, Clock::now());
    std::this_thread::sleep_until(next);
  }
  if (arguments.quiet) return;
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  fmt::print("\n{:.1f} s played in {:.1f} s; {:.1f} images a second and robot; cyan {} : {} magenta\n", match.t(),
             seconds, static_cast<double>(match.report().images) / arguments.match.robots / std::max(seconds, 1e-9),
             match.score().cyan, match.score().magenta);
  constexpr double slower = 0.95;  // is seen
  if (is_paced(arguments) && match.t() < slower * arguments.speed * seconds)
    fmt::print("that is {:.1f} times as fast as time, asked for was {:g}: fewer --robots or --fps are easier\n",
               match.t() / seconds, arguments.speed);
}

/// Of whatever team plays by its cameras.
std::unique_ptr<SimMatch> trained_match(const SimMatchOptions& options, bool quiet) {
  if (!quiet) {
    fmt::print("training the colors on rendered stills\n");
    std::fflush(stdout);
  }
  auto match = std::make_unique<SimMatch>(options);
  if (!quiet)
    fmt::print("{:.2f} % of the pixels of held-out stills are classified right\n", 100 * match->colors_quality());
  return match;
}

int demo(const DemoArguments& arguments) {
  end_cleanly_on_signals();
  SimMatchOptions options = arguments.match;
  options.field = read_field(arguments.field);
  options.cyan_own_goal = side_of(options.field, arguments.own_goal);
  options.compares_radios = arguments.compares_radios;
  options.is_paced = is_paced(arguments) && arguments.speed <= 1;
  std::unique_ptr<SimMatch> match;
  if (arguments.is_headless) {
    match = trained_match(options, arguments.quiet);
    play(*match, arguments, is_interrupted);
  } else {
    options.bus = arguments.bus.options();
    MonitorOptions monitor;
    monitor.field = options.field;
    monitor.bus = *options.bus;
    monitor.web = arguments.web.options();
    monitor.record = arguments.record;
    monitor.memory_s = arguments.memory_s;
    LiveMonitor live(monitor);  // first: what is in its way is told at once
    match = trained_match(options, arguments.quiet);
    if (is_interrupted()) return 0;
    tell_address(monitor.web, live.url());
    Beside listener(live);
    play(*match, arguments, [&] { return is_interrupted() || listener.has_failed(); });
    listener.finish();
    if (!arguments.quiet) fmt::print("bus: {}", live.summary());
  }
  if (arguments.reports || arguments.compares_radios) fmt::print("{}", text_of(match->report()));
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
  command
      ->add_option("--own-goal", arguments->own_goal,
                   "the goal that cyan defends (default: the yellow one, where the field has one)")
      ->check(CLI::IsMember({"yellow", "blue"}));
  command->add_option("--fps", arguments->match.frame_rate, "images a second of each robot")
      ->check(CLI::Range(5., 60.))
      ->capture_default_str();
  command->add_option("--seed", arguments->match.seed, "another match")->capture_default_str();
  command
      ->add_option("--loss", arguments->match.loss,
                   "share of what robots tell each other that is lost; not of what the monitor hears")
      ->check(CLI::Range(0., 0.95))
      ->capture_default_str();
  command
      ->add_option("--delay", arguments->match.delay_s, "how long the rest takes, in the mean, but to the monitor [s]")
      ->check(CLI::Range(0., 1.))
      ->capture_default_str();
  command->add_option("--opponents", arguments->match.opponents, "how fast magenta drives, of cyan's speed")
      ->check(CLI::Range(0., 1.))
      ->capture_default_str();
  command->add_flag("--unrest", arguments->match.has_unrest,
                    "robots leave and come back, and garbage is sent to those who play on");
  command->add_flag("--dark", arguments->match.is_dark, "cyan's cameras show black");
  command->add_option("--duration", arguments->duration, "end after so many seconds of play (default: Ctrl-C)")
      ->check(CLI::Range(0.1, 1e6));
  auto* headless = command->add_flag("--headless", arguments->is_headless,
                                     "without bus and monitor, as fast as it goes; needs --duration");
  command->add_option("--speed", arguments->speed, "of play, real time being 1; 0: as fast as it goes")
      ->excludes(headless)
      ->check(CLI::Range(0., 10.))
      ->capture_default_str();
  command->add_option("--memory", arguments->memory_s, "seconds that can be looked back at in the monitor")
      ->excludes(headless)
      ->check(CLI::Range(1., 3600.))
      ->capture_default_str();
  command->add_flag("--report", arguments->reports, "compare what was seen and known with the truth, at the end");
  command->add_flag("--radios", arguments->compares_radios,
                    "report also what a bench would know that hears all, over air that loses and delays more and less");
  command->add_option("--record", arguments->record, "write all that is told into this log, NAME.mcap")
      ->excludes(headless);
  command->add_flag("-q,--quiet", arguments->quiet, "print nothing but the address, the report and what goes wrong");
  const std::vector<const CLI::Option*> own = std::as_const(*command).get_options();
  arguments->bus.add_to(*command);
  arguments->web.add_to(*command);
  for (CLI::Option* option : command->get_options())
    if (std::ranges::find(own, option) == own.end()) option->excludes(headless);
  command->callback([arguments] {
    if (arguments->is_headless && !arguments->duration)
      throw CLI::ValidationError("--headless", "would never end, --duration is missing");
  });
  return [arguments] { return demo(*arguments); };
}

}  // namespace tassilo
