#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

// Numbers and tables as text for people.

namespace tassilo {

/// With so many digits after the point, "-" for nothing; never "-0.00".
std::string fixed(std::optional<double> value, int digits);
/// Nothing stays "-", without a unit.
std::string with_unit(const std::string& number, const char* unit);
std::string percent(std::optional<double> share);       ///< Of a share 0..1: "12.3 %".
std::string metres(std::optional<double> value);        ///< "1.234 m"
std::string degrees_text(std::optional<double> value);  ///< "1.23 deg"; of degrees.
std::string milliseconds(std::optional<double> value);  ///< "1.23 ms"
std::string of(std::int64_t count, const char* what);   ///< "of 3 frames"

/// Rows of cells in columns, two spaces between them; what is to the right may be missing.
class Columns {
 public:
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  /// All rows, each ended; cells of the columns [right_from, right_to) are aligned right. Columns are as wide as their
  /// widest cell looks, UTF-8 counted by characters.
  std::string text(std::size_t right_from, std::size_t right_to) const;

 private:
  std::vector<std::vector<std::string>> rows_;
};
constexpr std::size_t kToTheEnd = SIZE_MAX;

}  // namespace tassilo
