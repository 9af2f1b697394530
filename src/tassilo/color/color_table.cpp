#include "tassilo/color/color_table.h"

#include <string>

#include "tassilo/base/error.h"

namespace tassilo {

void ColorTable::check() const {
  for (const ColorClass color : kColorClasses) {
    const auto& interval = brightness[static_cast<std::size_t>(class_index(color))];
    if (interval.low < 0 || interval.high > 255)
      throw Error(
          "brightness." + std::string(to_string(color)),
          "is [" + std::to_string(interval.low) + ", " + std::to_string(interval.high) + "], must lie in [0, 255]");
  }
  ClassBits seen = 0;
  for (const ColorClass color : priority) seen |= class_bit(color);
  if (seen != 0xff) throw Error("priority", "must name each of the 8 color classes exactly once");
}

ColorClass classify(const ColorTable& table, int y, int u, int v) {
  const ClassBits bits = table.cell(u, v);
  for (const ColorClass color : table.priority)
    if ((bits & class_bit(color)) != 0 && table.brightness[static_cast<std::size_t>(class_index(color))].contains(y))
      return color;
  return ColorClass::no_color;
}

}  // namespace tassilo
