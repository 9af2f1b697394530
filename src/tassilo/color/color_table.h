#pragma once

#include <array>
#include <cstdint>

#include "tassilo/color/color_class.h"
#include "tassilo/image/frame.h"

namespace tassilo {

/// Closed interval of brightness. [0..255]; low > high is empty.
struct BrightnessInterval {
  int low = 0, high = 255;
  bool contains(int y) const { return low <= y && y <= high; }
  friend bool operator==(const BrightnessInterval&, const BrightnessInterval&) = default;
};

/// Order in which classes win where several claim the same (Y, U, V).
using ClassPriority = std::array<ColorClass, kColorClassCount>;
inline constexpr ClassPriority kDefaultPriority{ColorClass::red,   ColorClass::yellow,  ColorClass::blue,
                                                ColorClass::cyan,  ColorClass::magenta, ColorClass::green,
                                                ColorClass::white, ColorClass::black};

/// Which colors are which class: a plain value, replaced as a whole between two frames.
///
/// A pixel (Y, U, V) belongs to class k when cell (U, V) has the class's bit and Y lies in its brightness interval;
/// of several such classes the first in `priority` wins.
struct ColorTable {
  std::array<ClassBits, 256 * 256> chroma{};                      ///< chroma[V * 256 + U]
  std::array<BrightnessInterval, kColorClassCount> brightness{};  ///< by class_index
  ColorRange range = ColorRange::limited;                         ///< The quantization the table was trained for.
  ClassPriority priority = kDefaultPriority;

  ClassBits& cell(int u, int v) { return chroma[static_cast<std::size_t>(v * 256 + u)]; }
  ClassBits cell(int u, int v) const { return chroma[static_cast<std::size_t>(v * 256 + u)]; }
  friend bool operator==(const ColorTable&, const ColorTable&) = default;

  /// Throws Error when an interval leaves 0..255 or priority is no permutation.
  void check() const;
};

/// The class of one pixel by definition; the reference every kernel must equal. O(1).
ColorClass classify(const ColorTable& table, int y, int u, int v);

}  // namespace tassilo
