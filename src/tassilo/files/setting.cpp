#include "tassilo/files/setting.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "tassilo/base/error.h"
#include "tassilo/files/nearest_name.h"

namespace tassilo {
namespace {

/// The whole text as a number; nothing when it is none, does not fit, or is followed by anything.
template <class Number>
std::optional<Number> parsed(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

template <class Number>
std::string range_text(Number low, Number high, const std::string& low_text, const std::string& high_text) {
  const bool has_low = low > std::numeric_limits<Number>::lowest(),
             has_high = high < std::numeric_limits<Number>::max();
  if (has_low && has_high) return ">= " + low_text + " and <= " + high_text;
  return has_low ? ">= " + low_text : "<= " + high_text;
}

}  // namespace

double Setting::number(double low, double high) const {
  const auto value = quoted ? std::nullopt : parsed<double>(text);
  if (!value || !std::isfinite(*value)) fail("must be a finite number");
  if (*value < low || *value > high) fail("must be " + range_text(low, high, number_text(low), number_text(high)));
  return *value;
}

double Setting::positive() const {
  const double value = number();
  if (!(value > 0)) fail("must be > 0");
  return value;
}

std::int64_t Setting::integer(std::int64_t low, std::int64_t high) const {
  const auto value = quoted ? std::nullopt : parsed<std::int64_t>(text);
  if (!value) fail("must be a whole number");
  if (*value < low || *value > high)
    fail("must be " + range_text(low, high, std::to_string(low), std::to_string(high)));
  return *value;
}

bool Setting::boolean() const {
  if (!quoted && text == "true") return true;
  if (!quoted && text == "false") return false;
  fail("must be true or false");
}

std::size_t Setting::choice(std::span<const std::string_view> names) const {
  const auto found = std::ranges::find(names, std::string_view(text));
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  const auto near = nearest_name(text, names);
  fail("must be " + joined(names) + (near ? "; did you mean " + std::string(*near) + "?" : ""));
}

void Setting::fail(const std::string& must) const {
  throw Error(place,
              (name.empty() ? "" : name + " ") + "is " + (quoted ? "the text " : "") + shown(text) + ", " + must);
}

std::string joined(std::span<const std::string_view> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 < names.size() ? ", " : " or ";
    text += names[i];
  }
  return text;
}

std::string shown(std::string_view text) {
  constexpr std::size_t kMaxShown = 40;
  std::string out = "'";
  for (const char c : text.substr(0, kMaxShown)) out += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
  return out + (text.size() > kMaxShown ? "...'" : "'");
}

std::string number_text(double value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value + 0.0);  // -0 is 0
  return std::string(buffer.data(), error == std::errc() ? end : buffer.data());
}

}  // namespace tassilo
