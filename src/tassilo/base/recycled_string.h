#pragma once

#include <string>

#include "tassilo/base/recycled.h"

namespace tassilo {

/// A std::string for what lives as long as a frame.
using RecycledString = std::basic_string<char, std::char_traits<char>, RecyclingAllocator<char>>;

}  // namespace tassilo
