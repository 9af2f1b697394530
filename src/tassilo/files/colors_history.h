#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tassilo/files/colors_file.h"

// Tables that a colors file had before, each a colors file of its own in the folder STEM_history beside it.

namespace tassilo {

/// One of them.
struct FormerColors {
  std::string id;     ///< When it was put there, UTC: "2026-11-28T01-02-03Z", with "-2" and so on within a second.
  ColorsFile colors;  ///< Without a table when it cannot be read.
  std::string fault;  ///< Why it cannot; empty when it can.
};

/// Newest first; empty without such a folder. Reads all of them: about a millisecond each.
std::vector<FormerColors> read_history(const std::filesystem::path& colors_file);

/// Puts a table there, and into `history`, which is what `read_history` gave; returns its id. A table that is already
/// there, with the same provenance, is not put there twice. `now`: as in the id. Throws Error when it cannot be
/// written.
std::string keep_in_history(const std::filesystem::path& colors_file, const ColorsFile& colors, const std::string& now,
                            std::vector<FormerColors>& history);

}  // namespace tassilo
