#include "tassilo/color/color_class.h"

namespace tassilo {
namespace {

constexpr std::array<std::string_view, kColorClassCount + 1> kNames{"no_color", "black",   "white", "green", "blue",
                                                                    "cyan",     "magenta", "red",   "yellow"};

}  // namespace

std::string_view to_string(ColorClass color) { return kNames[static_cast<std::size_t>(color)]; }

std::optional<ColorClass> color_class_from(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == name) return static_cast<ColorClass>(i);
  return std::nullopt;
}

}  // namespace tassilo
