#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace tassilo {

// To add a verb: 1. a file <verb>_command.cpp with `add_<verb>`; 2. its line here and in main.cpp.

/// A verb adds its sub-command with options and help to the program; the returned function runs it, for its exit code.
using Command = std::function<int()>;

Command add_run(CLI::App& program);
Command add_train_colors(CLI::App& train);
Command add_calibrate(CLI::App& program);
Command add_eval(CLI::App& program);
Command add_compare(CLI::App& program);
Command add_info(CLI::App& program);

}  // namespace tassilo
