#include <fcntl.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <system_error>

#include "tassilo/app/commands.h"
#include "tassilo/app/usage.h"
#include "tassilo/base/error.h"
#include "tassilo/base/kernel.h"

namespace tassilo {
namespace {

/// A standard stream that is closed would be the next file to be opened: messages would go into a recording. Its number
/// is taken by something that fails to be used.
void occupy_closed_streams() {
  for (int stream = 0; stream <= 2; ++stream)
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF) open("/dev/null", stream == 0 ? O_WRONLY : O_RDONLY);
}

/// What was printed is not told before it is out: on a full disk it never is.
void flush_standard_output() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw Error("standard output", std::string("cannot be written: ") + std::strerror(errno));
}

/// Returns the exit code of a failure. A closed or full standard error is no further one.
int failure(const std::string& message) {
  std::fputs(("tassilo: " + message + "\n").c_str(), stderr);
  return 1;
}

}  // namespace
}  // namespace tassilo

/// Exit codes: 0 done, 1 the world failed (a file, a stream), 2 wrong usage, 3 what `compare --exit-code` tells.
int main(int argc, char** argv) {
  using namespace tassilo;
  occupy_closed_streams();
  CLI::App program{
      "Tassilo: color vision for robots, from camera frame to ball, goals, robots, lines and free motion space",
      "tassilo"};
  program.require_subcommand(1);
  program.set_version_flag("--version", TASSILO_VERSION);
  program.failure_message(usage_message);

  const Command run = add_run(program);
  const Command serve = add_serve(program);
  const Command demo = add_demo(program);
  const Command monitor = add_monitor(program);
  const Command replay = add_replay(program);
  auto* train = program.add_subcommand("train", "train what the vision needs");
  train->require_subcommand(1);
  const Command train_colors = add_train_colors(*train);
  const Command calibrate = add_calibrate(program);
  const Command eval = add_eval(program);
  const Command compare = add_compare(program);
  auto* sim = program.add_subcommand("sim", "a simulated world");
  sim->require_subcommand(1);
  const Command sim_render = add_sim_render(*sim);
  const Command info = add_info(program);
  const auto command = [&] {
    if (program.got_subcommand("run")) return run();
    if (program.got_subcommand("serve")) return serve();
    if (program.got_subcommand("demo")) return demo();
    if (program.got_subcommand("monitor")) return monitor();
    if (program.got_subcommand("replay")) return replay();
    if (program.got_subcommand("train")) return train_colors();
    if (program.got_subcommand("calibrate")) return calibrate();
    if (program.got_subcommand("eval")) return eval();
    if (program.got_subcommand("compare")) return compare();
    if (program.got_subcommand("sim")) return sim_render();
    return info();
  };

  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = program.exit(error);
    return code == 0 ? 0 : 2;
  }
  try {
    if (const char* kernel = std::getenv("TASSILO_KERNEL")) use_kernel(std::string_view(kernel));
    const int code = command();
    flush_standard_output();
    return code;
  } catch (const Error& error) {
    return failure(error.what());
  } catch (const std::system_error& error) {  // what the system refused, and no reader foresaw
    if (std::ferror(stdout) != 0) return failure("standard output: cannot be written: " + error.code().message());
    return failure(error.what());
  } catch (const std::exception& error) {
    return failure(std::string("unexpected: ") + error.what());
  }
}
