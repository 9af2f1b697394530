#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace tassilo {

/// Shortest text that reads back as the same double to the last bit, the sign of zero included; unlike `number_text`,
/// which is for people.
inline std::string exact_number(double value) {
  if (value == 0) return std::signbit(value) ? "-0.0" : "0";  // JSON's -0 is a whole number, which has no sign
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return std::string(buffer.data(), error == std::errc() ? end : buffer.data());
}

}  // namespace tassilo
