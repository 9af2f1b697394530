#pragma once

#include <functional>
#include <string>

#include "tassilo/base/error.h"

namespace tassilo {

/// What the Error says that an action throws. Tests only.
inline std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was refused";
}

/// The text with its first `from` replaced; fails loudly when there is none, so that no test case spoils nothing.
inline std::string spoiled(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) return "# the test looks for " + from + " in vain";
  return text.replace(at, from.size(), to);
}

}  // namespace tassilo
