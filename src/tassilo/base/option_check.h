#pragma once

#include <cmath>
#include <string>

#include "tassilo/base/error.h"

namespace tassilo {

// Options are checked where they are used; `option` is what messages call one, as "line.max_gap". NaN passes none.

/// Throws Error unless value > low.
inline void check_above(const std::string& option, double value, double low) {
  if (!(value > low)) throw Error(option, "is " + std::to_string(value) + ", must be > " + std::to_string(low));
}
/// Throws Error unless value >= low.
inline void check_at_least(const std::string& option, double value, double low) {
  if (!(value >= low)) throw Error(option, "is " + std::to_string(value) + ", must be >= " + std::to_string(low));
}
/// Throws Error unless low <= value <= high.
inline void check_between(const std::string& option, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw Error(option,
                "is " + std::to_string(value) + ", must be " + std::to_string(low) + " .. " + std::to_string(high));
}
/// Throws Error for an infinite value, and for NaN.
inline void check_finite(const std::string& option, double value) {
  if (!std::isfinite(value)) throw Error(option, "is " + std::to_string(value) + ", must be finite");
}

}  // namespace tassilo
