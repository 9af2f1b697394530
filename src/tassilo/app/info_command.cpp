#include <fmt/core.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "tassilo/app/commands.h"
#include "tassilo/base/kernel.h"
#include "tassilo/files/field_file.h"
#include "tassilo/vision/options.h"

namespace tassilo {
namespace {

void print_options() {
  fmt::print("Keys below `vision:` in robot.yaml; every one may be left out.\n\n");
  fmt::print("{:24}{:>10}  {:6}{:18}  {}\n", "key", "default", "unit", "range", "meaning");
  for (const OptionInfo& option : vision_option_infos())
    fmt::print("{:24}{:>10}  {:6}{:18}  {}\n", option.key, fmt::format("{:g}", option.standard), option.unit,
               fmt::format("{:g} .. {:g}{}", option.low, option.high, option.whole ? " whole" : ""), option.meaning);
}

void print_overview() {
  std::string others;
  for (const Kernel kernel : supported_kernels())
    if (kernel != kernel_in_use()) others += (others.empty() ? "" : ", ") + std::string(to_string(kernel));
  const char* const chosen = std::getenv("TASSILO_KERNEL");
  fmt::print("tassilo {}\n\nkernel: {}, {}; this machine also runs {} (TASSILO_KERNEL=name chooses)\n", TASSILO_VERSION,
             to_string(kernel_in_use()),
             chosen != nullptr ? "chosen by TASSILO_KERNEL" : "the fastest that this machine runs",
             others.empty() ? "no other" : others);
  fmt::print("\nfolders of shipped files, first hit wins:\n");
  for (const auto& folder : config_folders()) fmt::print("  {}\n", folder.string());
}

}  // namespace

Command add_info(CLI::App& program) {
  auto* command = program.add_subcommand("info", "tell about this program");
  auto options = std::make_shared<bool>(false);
  command->add_flag("--options", *options, "list the options of the vision: default, unit, range, meaning");
  return [options] {
    *options ? print_options() : print_overview();
    return 0;
  };
}

}  // namespace tassilo
