#pragma once

#include <filesystem>
#include <string>
#include <string_view>

// Names for what is kept beside a file that is replaced.

namespace tassilo {

/// The present time as file names have it, UTC: "2026-11-28T01-02-03Z". Names sort as times do.
std::string time_for_names();

/// The folder STEM_history beside a file, whether it is there or not.
std::filesystem::path history_folder(const std::filesystem::path& file);

/// A file NAME.EXTENSION of a folder that is not there yet, or NAME-2.EXTENSION and so on. `extension` with its dot.
/// Makes the folder. Throws Error when it cannot be made.
std::filesystem::path unused_file(const std::filesystem::path& folder, const std::string& name,
                                  std::string_view extension);

}  // namespace tassilo
