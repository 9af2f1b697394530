#include <fmt/core.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "tassilo/app/commands.h"
#include "tassilo/app/written_files.h"
#include "tassilo/base/error.h"
#include "tassilo/evaluate/evaluate.h"
#include "tassilo/files/atomic_file.h"

namespace tassilo {
namespace {

struct EvalArguments {
  std::vector<std::string> pairs, colors, balls, poses;
  std::string meta, exclude_samples, json;
  std::vector<std::string> exclude;
};

/// Throws Error when the figures would take the place of what they are made from.
void check_json_path(const EvalArguments& arguments) {
  std::vector<NamedFile> read;
  for (const auto* list : {&arguments.pairs, &arguments.balls, &arguments.poses})
    for (const std::string& path : *list) read.push_back({"truth or scenes", path});
  read.push_back({"--meta", arguments.meta});
  read.push_back({"--exclude-samples", arguments.exclude_samples});
  check_written_files(read, std::array<NamedFile, 1>{{{"--json", arguments.json}}});
}

int eval_command(const EvalArguments& arguments) {
  EvaluateOptions options;
  for (std::size_t i = 0; i + 1 < arguments.pairs.size(); i += 2)
    options.sequences.push_back({arguments.pairs[i], arguments.pairs[i + 1]});
  for (std::size_t i = 0; i + 1 < arguments.colors.size(); i += 2)
    options.colors.push_back({arguments.colors[i], arguments.colors[i + 1]});
  if (!arguments.meta.empty()) options.meta = arguments.meta;
  if (!arguments.balls.empty()) {
    options.balls.emplace();
    options.balls->balls = arguments.balls[0];
    options.balls->scenes = arguments.balls[1];
    options.balls->exclude = arguments.exclude;
    if (!arguments.exclude_samples.empty()) options.balls->exclude_samples = arguments.exclude_samples;
  }
  if (!arguments.poses.empty()) options.poses = {arguments.poses[0], arguments.poses[1]};
  check_json_path(arguments);
  const Evaluation evaluation = evaluate(options);
  // Nothing but JSON may go where JSON goes.
  fmt::print(arguments.json == "-" ? stderr : stdout, "{}", table(evaluation));
  if (arguments.json == "-")
    fmt::print("{}", to_json(evaluation));
  else if (!arguments.json.empty())
    write_atomically(arguments.json, to_json(evaluation));
  return 0;
}

}  // namespace

Command add_eval(CLI::App& program) {
  auto* command = program.add_subcommand("eval", "measure scenes against the truth of a recording");
  auto arguments = std::make_shared<EvalArguments>();
  command->add_option("pairs", arguments->pairs, "TRUTH SCENES [TRUTH SCENES ...]: gt.jsonl and scene lines");
  command->add_option("--meta", arguments->meta, "meta.json with the field (default: beside each truth)");
  command->add_option("--colors", arguments->colors, "LABELS_DIR MAPS_DIR: true and found label maps; may be repeated")
      ->type_size(2)
      ->expected(-1);
  auto* balls =
      command->add_option("--balls", arguments->balls, "BALLS.json SCENES: balls in single images")->expected(2);
  command->add_option("--exclude", arguments->exclude, "with --balls: leave these images out")
      ->delimiter(',')
      ->needs(balls);
  command
      ->add_option("--exclude-samples", arguments->exclude_samples,
                   "with --balls: leave out the images of samples.yaml")
      ->needs(balls);
  command->add_option("--poses", arguments->poses, "POSES.csv SCENES: poses in single images")->expected(2);
  command->add_option("--json", arguments->json, "write all figures there; - for standard output");
  command->callback([arguments] {
    if (arguments->pairs.size() % 2 != 0)
      throw CLI::ValidationError("pairs", "give pairs: each TRUTH needs its SCENES");
    if (arguments->pairs.empty() && arguments->colors.empty() && arguments->balls.empty() && arguments->poses.empty())
      throw CLI::ValidationError("pairs", "give pairs TRUTH SCENES, or --colors, --balls, --poses");
  });
  return [arguments] { return eval_command(*arguments); };
}

}  // namespace tassilo
