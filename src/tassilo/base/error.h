#pragma once

#include <stdexcept>
#include <string>

namespace tassilo {

/// The outside world failed us: a file, a device, a socket, a configuration entry.
///
/// Thrown by doors, readers and `check()`; caught once, by the program or by whoever embeds the library.
/// `subject` names the thing (a file with line, an option), `reason` says what it is and what it must be;
/// lower-case, no full stop.
class Error : public std::runtime_error {
 public:
  Error(const std::string& subject, const std::string& reason) : std::runtime_error(subject + ": " + reason) {}
};

}  // namespace tassilo
