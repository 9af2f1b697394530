#include <fmt/core.h>

#include <array>
#include <memory>
#include <string>

#include "tassilo/app/commands.h"
#include "tassilo/app/written_files.h"
#include "tassilo/evaluate/compare.h"
#include "tassilo/files/atomic_file.h"

namespace tassilo {
namespace {

constexpr int kDiffers = 3;  ///< Exit code, where asked for.

struct CompareArguments {
  std::string a, b, truth, meta, json;
  int max_rows = 5;
  bool exit_code = false;
};

int compare_command(const CompareArguments& arguments) {
  CompareOptions options{arguments.a, arguments.b, {}, {}};
  if (!arguments.truth.empty()) options.truth = arguments.truth;
  if (!arguments.meta.empty()) options.meta = arguments.meta;
  check_written_files(
      std::array<NamedFile, 4>{
          {{"scenes", arguments.a}, {"scenes", arguments.b}, {"--truth", arguments.truth}, {"--meta", arguments.meta}}},
      std::array<NamedFile, 1>{{{"--json", arguments.json}}});
  const Comparison comparison = compare(options);
  // Nothing but JSON may go where JSON goes.
  fmt::print(arguments.json == "-" ? stderr : stdout, "{}", table(comparison, arguments.max_rows));
  if (arguments.json == "-")
    fmt::print("{}", to_json(comparison));
  else if (!arguments.json.empty())
    write_atomically(arguments.json, to_json(comparison));
  return arguments.exit_code && !comparison.equal() ? kDiffers : 0;
}

}  // namespace

Command add_compare(CLI::App& program) {
  auto* command = program.add_subcommand("compare", "show two runs over one recording side by side");
  auto arguments = std::make_shared<CompareArguments>();
  command->add_option("a", arguments->a, "scene lines of one run, from `tassilo run --output`")->required();
  command->add_option("b", arguments->b, "scene lines of the other run; lines are matched by `frame`")->required();
  auto* truth = command->add_option("--truth", arguments->truth,
                                    "gt.jsonl of the recording: how good both are, as `tassilo eval` measures it, "
                                    "B - A, and which is better");
  command->add_option("--meta", arguments->meta, "with --truth: meta.json with the field (default: beside the truth)")
      ->needs(truth);
  command
      ->add_option("--max-rows", arguments->max_rows, "of each subject, name so many of the frames in which it differs")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--json", arguments->json, "write all figures there; - for standard output");
  command->add_flag("--exit-code", arguments->exit_code,
                    "exit with 3 when the runs differ in a frame or in anything seen, timing apart; 0 when equal");
  return [arguments] { return compare_command(*arguments); };
}

}  // namespace tassilo
