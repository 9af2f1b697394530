#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tassilo {

/// The recordings beside the checkout; may be absent, then tests on them are skipped. Tests only.
inline std::filesystem::path shared_data() { return std::filesystem::path(TASSILO_SOURCE_DIR) / "../shared/data"; }

/// All files below the folder with this name, in order.
inline std::vector<std::filesystem::path> files_named(const std::filesystem::path& folder, const std::string& name) {
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().filename() == name) found.push_back(entry.path());
  return found;
}

}  // namespace tassilo
