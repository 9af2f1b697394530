#include "tassilo/overlay/internal/text.h"

#include <array>
#include <charconv>
#include <cmath>

#include "tassilo/base/unsigned_zero.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {

std::string fixed(double value, int decimals) {
  std::array<char, 400> text{};  // room for the largest double
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, decimals).ptr;
  return unsigned_zero({text.data(), end});
}

std::string meters(double value) { return fixed(value, 2) + " m"; }
std::string percent(double fraction) { return fixed(100 * fraction, 0) + " %"; }

std::string number_text(int id) { return std::string("#").append(std::to_string(id)); }

std::string joined(std::initializer_list<std::string> parts) {
  std::string all;
  for (const std::string& part : parts) {
    if (!all.empty() && !part.empty()) all += " · ";
    all += part;
  }
  return all;
}

std::string bearing_text(double angle) {
  const long rounded = std::lround(degrees(angle));
  if (rounded == 0) return "ahead";
  return std::to_string(std::labs(rounded)) + (rounded > 0 ? "° left" : "° right");
}

}  // namespace tassilo
