#pragma once

#include <array>
#include <charconv>
#include <string>

namespace tassilo {

/// Shortest text that reads back as the same double to the last bit, the sign of zero included; unlike `number_text`,
/// which is for people.
inline std::string exact_number(double value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return std::string(buffer.data(), error == std::errc() ? end : buffer.data());
}

}  // namespace tassilo
