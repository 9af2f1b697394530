#pragma once

#include <span>
#include <string>

#include "tassilo/vision/stages.h"

namespace tassilo {

/// Adds the alternatives of shared libraries (vision/plugin.h) to a registry, in the order of the files; a file that is
/// named twice, by whatever path, adds them once. A library is code that runs with all rights of the program: load no
/// file that its user did not name.
///
/// A loaded library stays until the program ends: the registry, every Vision made from it, and exceptions on their way
/// hold functions of it. A file that took the place of a loaded one is loaded beside it.
///
/// Throws Error naming the file that does not exist, is no library for this program, throws, registers nothing, takes
/// names that are taken, or changes the alternatives of others.
StageRegistry with_plugins(StageRegistry registry, std::span<const std::string> files);

}  // namespace tassilo
