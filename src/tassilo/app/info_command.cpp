#include <fmt/core.h>

#include <memory>

#include "tassilo/app/commands.h"
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
  fmt::print("tassilo {}\n\nfolders of shipped files, first hit wins:\n", TASSILO_VERSION);
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
