#pragma once

namespace tassilo {

/// From now on Ctrl-C and a friendly kill are noted, and the program ends when it has finished what it is at; a second
/// one ends it at once.
void end_cleanly_on_signals();
/// Was one noted?
bool is_interrupted();

}  // namespace tassilo
