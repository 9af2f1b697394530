#include "tassilo/evaluate/internal/text_table.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "tassilo/base/unsigned_zero.h"

namespace tassilo {
namespace {

/// Characters a person sees: bytes of UTF-8 that begin one.
std::size_t shown_width(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](unsigned char c) { return (c & 0xC0) != 0x80; }));
}
std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::size_t seen = shown_width(text);
  const std::string fill(seen < width ? width - seen : 0, ' ');
  return right ? fill + text : text + fill;
}

}  // namespace

std::string fixed(std::optional<double> value, int digits) {
  if (!value) return "-";
  std::array<char, 400> text;  // the longest double has 309 digits before the point
  const int length = std::snprintf(text.data(), text.size(), "%.*f", digits, *value);
  return unsigned_zero(std::string(text.data(), static_cast<std::size_t>(length)));
}
std::string with_unit(const std::string& number, const char* unit) { return number == "-" ? number : number + unit; }
std::string percent(std::optional<double> share) {
  return with_unit(fixed(share ? std::optional(100 * *share) : share, 1), " %");
}
std::string metres(std::optional<double> value) { return with_unit(fixed(value, 3), " m"); }
std::string degrees_text(std::optional<double> value) { return with_unit(fixed(value, 2), " deg"); }
std::string milliseconds(std::optional<double> value) { return with_unit(fixed(value, 2), " ms"); }
std::string of(std::int64_t count, const char* what) { return "of " + std::to_string(count) + " " + what; }

std::string Columns::text(std::size_t right_from, std::size_t right_to) const {
  std::vector<std::size_t> widths;
  for (const auto& row : rows_) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], shown_width(row[i]));
  }
  std::string out;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += (i ? "  " : "") + padded(row[i], widths[i], i >= right_from && i < right_to);
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

}  // namespace tassilo
