#include "tassilo/files/internal/yaml_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>

#include "tassilo/files/setting.h"

namespace tassilo {
namespace {

bool is_simple(std::string_view text) {
  constexpr std::array<std::string_view, 7> kSpecial{"true", "false", "null", "yes", "no", "on", "off"};
  if (text.empty() || !std::isalpha(static_cast<unsigned char>(text[0])))
    return text.starts_with("../") && is_simple(text.substr(3));
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (std::ranges::find(kSpecial, lower) != kSpecial.end()) return false;
  return std::ranges::all_of(
      text, [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.' || c == '/' || c == '-'; });
}

}  // namespace

std::string yaml_text(std::string_view text) {
  if (is_simple(text)) return std::string(text);
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 32 || c == 127) {
      std::array<char, 8> code;
      std::snprintf(code.data(), code.size(), "\\x%02x", static_cast<unsigned>(c));
      out += code.data();
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string yaml_numbers(std::span<const double> numbers) {
  std::string out = "[";
  for (std::size_t i = 0; i < numbers.size(); ++i) out.append(i > 0 ? ", " : "").append(number_text(numbers[i]));
  return out + "]";
}

std::string yaml_path(const std::filesystem::path& target, const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  const auto absolute = [](const fs::path& path) { return fs::absolute(path.empty() ? "." : path).lexically_normal(); };
  return yaml_text(absolute(target).lexically_proximate(absolute(folder)).string());
}

}  // namespace tassilo
