#pragma once

namespace tassilo {

/// A place in the source: where a function with a defaulted argument of this type was called.
/// std::source_location would do, but clang 14, the clang of Debian 12, does not have it.
struct SourcePlace {
  const char* file = "";
  int line = 0;
  const char* function = "";

  static constexpr SourcePlace current(const char* file = __builtin_FILE(), int line = __builtin_LINE(),
                                       const char* function = __builtin_FUNCTION()) {
    return {file, line, function};
  }
};

/// Prints the broken promise with its place and ends the program. Never returns.
[[noreturn]] void broken_promise(const char* promise, SourcePlace at = SourcePlace::current());

/// A promise between our own functions. Never for input from outside: that is an Error.
inline void expects(bool holds, const char* promise, SourcePlace at = SourcePlace::current()) {
  if (!holds) [[unlikely]]
    broken_promise(promise, at);
}

}  // namespace tassilo
