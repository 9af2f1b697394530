#include "tassilo/app/number_list.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace tassilo {

bool read_numbers(std::string_view text, std::span<double* const> numbers, std::size_t least) {
  std::size_t count = 0;
  for (std::size_t begin = 0; begin <= text.size(); ++count) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    double value = NAN;
    const auto [rest, error] = std::from_chars(text.data() + begin, text.data() + end, value);
    if (count == numbers.size() || error != std::errc{} || rest != text.data() + end || !std::isfinite(value))
      return false;
    *numbers[count] = value;
    begin = end + 1;
  }
  return count >= least;
}

}  // namespace tassilo
