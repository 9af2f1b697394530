#pragma once

#include <string_view>

#include "tassilo/files/document.h"

namespace tassilo {

/// Parses one JSON text, strictly by RFC 8259; duplicate keys and deep nesting are refused. `place` is how messages
/// call it, usually "file:line". Throws Error(place, what is wrong).
Value parse_json(std::string_view text, std::string_view place);

}  // namespace tassilo
