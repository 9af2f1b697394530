#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace tassilo {

/// What to tell of a wrong command line: the verb, the word that is wrong with the nearest one that is right, where
/// help is; the list of verbs where none was given. Lines are ended.
std::string usage_message(const CLI::App* program, const CLI::Error& error);

}  // namespace tassilo
