#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace tassilo {

// To add a verb: 1. a file <verb>_command.cpp with `add_<verb>`; 2. its line here and in main.cpp.

/// A verb adds its sub-command with options and help to the program; the returned function runs it, for its exit code.
using Command = std::function<int()>;

/// --plugin FILE, as often as there are files.
inline void add_plugin_option(CLI::App& verb, std::vector<std::string>& files) {
  verb.add_option("--plugin", files, "shared library with further alternatives for stages; may be given several times")
      ->option_text("FILE")
      ->allow_extra_args(false);
}

Command add_run(CLI::App& program);
Command add_serve(CLI::App& program);
Command add_demo(CLI::App& program);
Command add_monitor(CLI::App& program);
Command add_replay(CLI::App& program);
Command add_train_colors(CLI::App& train);
Command add_calibrate(CLI::App& program);
Command add_calibrate_mount(CLI::App& calibrate);
Command add_eval(CLI::App& program);
Command add_compare(CLI::App& program);
Command add_sim_render(CLI::App& sim);
Command add_info(CLI::App& program);

}  // namespace tassilo
