#pragma once

#include <span>
#include <string>

namespace tassilo {

/// A file or folder as the command line or a configuration names it, and what it is for: "--output".
struct NamedFile {
  std::string role;
  std::string path;  ///< Empty, "-" and URLs are no files.
};

/// Throws Error when a file to be written is one that is read, or is to be written twice: a slip of the hand costs no
/// recording. A folder that is written into may not be one that is read. Links are followed; devices may be anything.
void check_written_files(std::span<const NamedFile> read, std::span<const NamedFile> written);

}  // namespace tassilo
