#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace tassilo {

/// Labels 0..8 of label maps and truth.
enum class ColorClass : std::uint8_t { no_color, black, white, green, blue, cyan, magenta, red, yellow };

inline constexpr int kColorClassCount = 8;  ///< Without no_color.
inline constexpr std::array<ColorClass, kColorClassCount> kColorClasses{
    ColorClass::black, ColorClass::white,   ColorClass::green, ColorClass::blue,
    ColorClass::cyan,  ColorClass::magenta, ColorClass::red,   ColorClass::yellow};

/// Lower-case name as in every file.
std::string_view to_string(ColorClass color);
/// Nothing for an unknown name; "no_color" is known.
std::optional<ColorClass> color_class_from(std::string_view name);

/// Position 0..7 among the real classes; not for no_color.
constexpr int class_index(ColorClass color) { return static_cast<int>(color) - 1; }

/// A set of classes; bit 0 = black .. bit 7 = yellow, as in colors.png.
using ClassBits = std::uint8_t;
constexpr ClassBits class_bit(ColorClass color) {
  return color == ColorClass::no_color ? ClassBits{0} : static_cast<ClassBits>(1u << class_index(color));
}

}  // namespace tassilo
