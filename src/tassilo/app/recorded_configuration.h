#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tassilo/app/configuration_watch.h"
#include "tassilo/files/start_state_file.h"

namespace tassilo {

/// Writes robot.yaml, and all that it names, into an empty folder, so that a run with it sees as `configuration` does:
/// what was loaded, not what the files say meanwhile, with what was changed in a browser. Plug-ins are copied as they
/// are now.
///
/// state     what was known before the first frame; none: the start pose counts, if there is one
/// remarks   for people, at the head of robot.yaml, lines that begin with #
/// Throws Error naming the file that cannot be written.
void write_configuration(const std::filesystem::path& folder, const Configuration& configuration,
                         const std::optional<StartState>& state, const std::string& remarks);

}  // namespace tassilo
