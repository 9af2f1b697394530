#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tassilo {

/// How many bytes are missing at the end of a file by its own account: Matroska/WebM (segment size), MP4/MOV (top-level
/// boxes), AVI (RIFF chunks). 0: complete, or unknown because the format or an unfinished recording does not say.
///
/// FFmpeg reads a container cut between two packets like a shorter one; this tells them apart.
std::int64_t missing_bytes(const std::string& path);

}  // namespace tassilo
