#include "tassilo/app/usage.h"

#include <fmt/core.h>

#include <optional>
#include <string_view>
#include <vector>

#include "tassilo/files/nearest_name.h"

namespace tassilo {
namespace {

/// All that may stand where `word` stands: options of a verb where it looks like one, else the verbs below.
std::vector<std::string> known_words(const CLI::App& verb, const std::string& word) {
  std::vector<std::string> known;
  if (word.starts_with("-")) {
    for (const CLI::Option* option : verb.get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  } else {
    for (const CLI::App* child : verb.get_subcommands([](const CLI::App*) { return true; }))
      known.push_back(child->get_name());
  }
  return known;
}

/// The first word that no verb understood. CLI11 complains of what is missing before it does of what is too much, and a
/// mistyped option is both.
std::optional<std::string> unknown_word(const CLI::App& verb) {
  const std::vector<std::string> rest = verb.remaining();
  for (const std::string& word : rest)
    if (word.starts_with("-")) return word;
  return rest.empty() ? std::nullopt : std::optional(rest.front());
}

}  // namespace

std::string usage_message(const CLI::App* program, const CLI::Error& error) {
  const CLI::App* verb = program;
  std::string above, name = program->get_name();
  while (!verb->get_subcommands().empty()) {
    verb = verb->get_subcommands().front();
    above = name;
    name += " " + verb->get_name();
  }
  const std::string help = fmt::format("`{} --help` tells more\n", name);
  if (const auto word = unknown_word(*verb)) {
    const std::vector<std::string> known = known_words(*verb, *word);
    const auto near = nearest_name(*word, std::vector<std::string_view>(known.begin(), known.end()));
    return fmt::format("{}: '{}' is not known{}\n{}", name, *word, near ? fmt::format("; did you mean {}?", *near) : "",
                       help);
  }
  if (error.get_name() == "RequiredError" && !verb->get_subcommands([](const CLI::App*) { return true; }).empty())
    return verb->help(above);
  return fmt::format("{}: {}\n{}", name, error.what(), help);
}

}  // namespace tassilo
