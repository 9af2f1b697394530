#pragma once

#include <string>

namespace tassilo {

/// A number as text, without the sign of a zero: "-0.00", which is what rounding leaves of -0.001, becomes "0.00".
inline std::string unsigned_zero(std::string number) {
  if (number.starts_with('-') && number.find_first_not_of("-0.") == std::string::npos) number.erase(0, 1);
  return number;
}

}  // namespace tassilo
