#pragma once

#include <source_location>

namespace tassilo {

/// Prints the broken promise with its place and ends the program. Never returns.
[[noreturn]] void broken_promise(const char* promise, std::source_location at);

/// A promise between our own functions. Never for input from outside: that is an Error.
inline void expects(bool holds, const char* promise, std::source_location at = std::source_location::current()) {
  if (!holds) [[unlikely]]
    broken_promise(promise, at);
}

}  // namespace tassilo
