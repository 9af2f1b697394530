#include <fmt/core.h>

#include <exception>

#include "tassilo/app/commands.h"
#include "tassilo/base/error.h"

/// Exit codes: 0 done, 1 the world failed (a file, a stream), 2 wrong usage.
int main(int argc, char** argv) {
  using namespace tassilo;
  CLI::App program{
      "Tassilo: color vision for robots, from camera frame to ball, goals, robots, lines and free motion space",
      "tassilo"};
  program.require_subcommand(1);
  program.set_version_flag("--version", TASSILO_VERSION);

  const Command run = add_run(program);
  auto* train = program.add_subcommand("train", "train what the vision needs");
  train->require_subcommand(1);
  const Command train_colors = add_train_colors(*train);
  const Command eval = add_eval(program);
  const Command info = add_info(program);

  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = program.exit(error);
    return code == 0 ? 0 : 2;
  }
  try {
    if (program.got_subcommand("run")) return run();
    if (program.got_subcommand("train")) return train_colors();
    if (program.got_subcommand("eval")) return eval();
    return info();
  } catch (const Error& error) {
    fmt::print(stderr, "tassilo: {}\n", error.what());
  } catch (const std::exception& error) {
    fmt::print(stderr, "tassilo: unexpected: {}\n", error.what());
  }
  return 1;
}
