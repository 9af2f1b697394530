#pragma once

#include "tassilo/color/color_class.h"
#include "tassilo/files/document.h"

namespace tassilo {

/// One of the eight color classes, by name.
ColorClass color_of(const Value& value);
/// One of the eight, or no_color.
ColorClass label_of(const Value& value);

}  // namespace tassilo
