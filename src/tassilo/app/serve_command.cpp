#include <fmt/core.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "tassilo/app/commands.h"
#include "tassilo/app/live_view.h"
#include "tassilo/app/recorder.h"
#include "tassilo/app/run.h"
#include "tassilo/app/terminal_qr.h"
#include "tassilo/web/access.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

struct ServeArguments {
  RunArguments run;
  WebOptions web;
  std::string pages, samples;
  std::string recordings = "recordings";
};

/// The first folder of pages that is there: what the environment says, beside the installed program, where this was
/// built.
fs::path pages_folder() {
  std::vector<fs::path> folders;
  if (const char* named = std::getenv("TASSILO_WEBUI")) folders.emplace_back(named);
  std::error_code error;
  if (const fs::path program = fs::read_symlink("/proc/self/exe", error); !error)
    folders.push_back(program.parent_path().parent_path() / "share/tassilo/webui");
  folders.emplace_back(TASSILO_INSTALLED_WEBUI);
  folders.emplace_back(TASSILO_BUILT_WEBUI);
  for (const fs::path& folder : folders)
    if (fs::exists(folder / "index.html", error)) return folder;
  return {};
}

int serve(const ServeArguments& arguments) {
  WebOptions web = arguments.web;
  web.pages = arguments.pages.empty() ? pages_folder() : fs::path(arguments.pages);
  // Who can reach it from elsewhere must have been told.
  if (!is_loopback(web.address) && web.token.empty()) web.token = new_token();
  Recorder recorder(arguments.recordings, false);
  LiveView live(web, arguments.run.robot, arguments.samples, &recorder);
  if (!arguments.run.quiet) {
    fmt::print("{} {} {}{}; Ctrl-C ends\n", web.pages.empty() ? "serving at" : "open", live.url(),
               web.pages.empty() ? "for programs" : "in a browser",
               is_loopback(web.address) ? "" : " (the address of this machine instead of " + web.address + ")");
    if (web.pages.empty())
      fmt::print(
          "without pages, only the interface for programs: they are built by `make release` where node and npm are\n");
    if (!is_loopback(web.address) && isatty(STDOUT_FILENO) == 1) fmt::print("{}", terminal_qr(live.url()));
    std::fflush(stdout);
  }
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
  command->add_option("--address", arguments->web.address, "IP address to listen at; beyond 127.0.0.1 with a token")
      ->capture_default_str();
  command->add_option("--port", arguments->web.port, "port to listen at; 0: any")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_option("--token", arguments->web.token, "secret that every request must carry; made when it is needed")
      ->check([](const std::string& token) {
        constexpr std::size_t least = 16;
        const bool is_plain =
            token.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ-_") ==
            std::string::npos;
        return is_plain && token.size() >= least ? "" : "must be 16 or more of a-z, A-Z, 0-9, - and _";
      });
  command->add_option("--samples", arguments->samples,
                      "samples.yaml of the color training, read and written (default: beside the color table)");
  command->add_option("--pages", arguments->pages, "folder with pages, instead of the installed ones")
      ->check(CLI::ExistingDirectory);
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
