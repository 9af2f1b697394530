#pragma once

#include <span>
#include <string_view>

namespace tassilo {

/// Reads "1.5,-2,3" into the numbers pointed to, in their order; those that the text does not have stay as they are.
/// False, with some perhaps read, unless the text is at least `least` finite numbers, at most as many as asked for.
bool read_numbers(std::string_view text, std::span<double* const> numbers, std::size_t least);

}  // namespace tassilo
