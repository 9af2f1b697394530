#pragma once

#include <filesystem>
#include <string_view>

namespace tassilo {

/// Replaces `file` by `bytes` in one step: whoever opens it sees the old content or the new one, also after a crash.
///
/// Writes a temporary file beside it, flushes it to the disk and renames it. A symbolic link stays a link: the file it
/// points to is replaced. Permissions of an existing file are kept. What is no file (a device, a pipe) is written into
/// as it is. Throws Error naming the file; it is then unchanged.
void write_atomically(const std::filesystem::path& file, std::string_view bytes);

}  // namespace tassilo
