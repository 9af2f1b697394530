#pragma once

#include <cstdint>
#include <limits>

#include "tassilo/base/contract.h"

namespace tassilo {

/// A run coordinate; leaving 16 bit is a broken promise, never a silent wrap. [px]
inline std::int16_t to_coordinate(int value) {
  using Limits = std::numeric_limits<std::int16_t>;
  expects(value >= Limits::min() && value <= Limits::max(), "run coordinates stay within signed 16 bit");
  return static_cast<std::int16_t>(value);
}

}  // namespace tassilo
