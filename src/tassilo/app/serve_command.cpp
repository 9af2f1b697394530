#include <memory>
#include <string>

#include "tassilo/app/commands.h"
#include "tassilo/app/live_view.h"
#include "tassilo/app/recorder.h"
#include "tassilo/app/run.h"
#include "tassilo/app/web_arguments.h"

namespace tassilo {
namespace {

struct ServeArguments {
  RunArguments run;
  WebArguments web;
  std::string samples;
  std::string recordings = "recordings";
};

int serve(const ServeArguments& arguments) {
  const WebOptions web = arguments.web.options();
  Recorder recorder(arguments.recordings, false);
  LiveView live(web, arguments.run.robot, arguments.samples, &recorder);
  if (!arguments.run.quiet) tell_address(web, live.url());
  return run(arguments.run, &live, &recorder);
}

}  // namespace

Command add_serve(CLI::App& program) {
  auto* command = program.add_subcommand(
      "serve",
      "run, and show it to browsers: live picture, scene, times; stages exchanged while it runs, changed files "
      "taken over; files are played in real time, again and again unless something is written of them");
  auto arguments = std::make_shared<ServeArguments>();
  add_run_options(*command, arguments->run);
  arguments->web.add_to(*command);
  command->add_option("--samples", arguments->samples,
                      "samples.yaml of the color training, read and written (default: beside the color table)");
  command
      ->add_option("--recordings", arguments->recordings,
                   "folder below which recordings are made that are begun in the browser")
      ->capture_default_str();
  command->callback([arguments] {
    arguments->run.watch = !arguments->run.robot.empty();
    understand(arguments->run);
  });
  return [arguments] { return serve(*arguments); };
}

}  // namespace tassilo
