#pragma once

#include <filesystem>
#include <string_view>

#include "tassilo/files/document.h"

namespace tassilo {

/// Parses one YAML document; `name` is how messages call it.
///
/// Stricter than YAML: duplicate keys, aliases, tags, several documents, complex keys and deep nesting are refused, so
/// that time and memory are bounded by the size of the text. Throws Error("name:line:column", what is wrong).
Value parse_yaml(std::string_view text, std::string_view name);

/// Reads and parses a file of at most 1 MiB.
Value read_yaml(const std::filesystem::path& file);

}  // namespace tassilo
