#include <fmt/core.h>

#include <memory>
#include <optional>
#include <string>

#include "tassilo/app/bus_arguments.h"
#include "tassilo/app/commands.h"
#include "tassilo/app/monitor.h"
#include "tassilo/app/signals.h"
#include "tassilo/app/web_arguments.h"
#include "tassilo/files/field_file.h"

namespace tassilo {
namespace {

struct MonitorArguments {
  WebArguments web;
  BusArguments bus;
  MonitorOptions monitor;
  std::string log, field = "msl98";
};

int monitor(const MonitorArguments& arguments) {
  MonitorOptions options = arguments.monitor;
  options.field = read_field(arguments.field);
  options.web = arguments.web.options();
  options.check();
  end_cleanly_on_signals();
  if (!arguments.log.empty()) {
    LogMonitor log(options, arguments.log);
    tell_address(options.web, log.url());
    log.run(is_interrupted);
    return 0;
  }
  options.bus = arguments.bus.options();
  LiveMonitor live(options);
  fmt::print("listening to domain {} on {}\n", options.bus.domain, options.bus.interface);
  tell_address(options.web, live.url());
  live.run(is_interrupted);
  fmt::print("{}", live.summary());
  return 0;
}

}  // namespace

Command add_monitor(CLI::App& program) {
  auto* command = program.add_subcommand(
      "monitor",
      "show the team to browsers: where all robots are and what they see, how they are; of the bus, or of a log");
  auto arguments = std::make_shared<MonitorArguments>();
  command->add_option("log", arguments->log, "log to be looked at, NAME.mcap; without one: the bus")
      ->check(CLI::ExistingFile);
  command->add_option("--field", arguments->field, "field: a shipped name or a path")->capture_default_str();
  command
      ->add_option("--robots", arguments->monitor.view.known_robots,
                   "numbers of the team's robots, such as 1,2,3; others are not believed (default: all are known)")
      ->delimiter(',')
      ->check(CLI::Range(0, 255));
  command->add_option("--record", arguments->monitor.record,
                      "write all that is heard into this log, NAME.mcap; pictures as far as somebody looks at them");
  command->add_option("--rate", arguments->monitor.rate, "team pictures a second for browsers")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--memory", arguments->monitor.memory_s, "seconds that can be looked back at")
      ->check(CLI::Range(1., 3600.))
      ->capture_default_str();
  arguments->bus.add_to(*command);
  arguments->web.add_to(*command);
  return [arguments] { return monitor(*arguments); };
}

}  // namespace tassilo
