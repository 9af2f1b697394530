#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace tassilo {

/// Text as a YAML scalar that reads back as the same text: in quotes unless it is a simple name or path.
std::string yaml_text(std::string_view text);
/// "[1, 2.5, -3]".
std::string yaml_numbers(std::span<const double> numbers);
/// `target` as it is written into a file in `folder`: relative to the folder where possible.
std::string yaml_path(const std::filesystem::path& target, const std::filesystem::path& folder);

}  // namespace tassilo
