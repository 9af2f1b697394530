#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace tassilo {

/// One scalar of a project file (or of a command line, a web form) as written, with what messages need: `place` (where
/// it stands, "robot.yaml:7:22") and `name` ("vision.field_boundary"). Every reader throws Error(place, "NAME is VALUE,
/// must be
/// ...") when the text is not what is asked for.
struct Setting {
  std::string place;
  std::string name;
  std::string text;
  bool quoted = false;  ///< Text in quotes is never a number nor true or false.

  /// A finite number in [low, high].
  double number(double low = -std::numeric_limits<double>::max(),
                double high = std::numeric_limits<double>::max()) const;
  /// A finite number > 0.
  double positive() const;
  /// A whole number in [low, high].
  std::int64_t integer(std::int64_t low = std::numeric_limits<std::int64_t>::min(),
                       std::int64_t high = std::numeric_limits<std::int64_t>::max()) const;
  /// true or false.
  bool boolean() const;
  /// Position of the text in `names`.
  std::size_t choice(std::span<const std::string_view> names) const;

  /// Throws Error(place, "NAME is VALUE, MUST"); `must` begins with "must be".
  [[noreturn]] void fail(const std::string& must) const;
};

/// "a, b or c".
std::string joined(std::span<const std::string_view> names);
/// Text from outside as messages show it: in quotes, printable, at most 40 characters.
std::string shown(std::string_view text);
/// Shortest text that reads back as the same number; 0 for -0.
std::string number_text(double value);

}  // namespace tassilo
