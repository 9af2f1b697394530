#pragma once

#include <string>

namespace tassilo {

/// A QR code of a text for a terminal, two rows of modules a line, dark on light whatever the terminal's colors; empty
/// when the text is too long for one.
std::string terminal_qr(const std::string& text);

}  // namespace tassilo
