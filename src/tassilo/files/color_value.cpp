#include "tassilo/files/internal/color_value.h"

#include <array>
#include <span>

namespace tassilo {
namespace {

std::array<std::string_view, kColorClassCount + 1> all_names() {
  std::array<std::string_view, kColorClassCount + 1> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = to_string(static_cast<ColorClass>(i));
  return names;
}

}  // namespace

ColorClass color_of(const Value& value) {
  const auto names = all_names();
  return kColorClasses[value.choice(std::span(names).subspan(1))];
}

ColorClass label_of(const Value& value) {
  const auto names = all_names();
  return static_cast<ColorClass>(value.choice(names));
}

}  // namespace tassilo
