#pragma once

#include <string_view>

#include "tassilo/source/internal/av_support.h"
#include "tassilo/source/picture.h"

namespace tassilo {

inline constexpr std::string_view kPngStart = "\x89PNG\r\n\x1a\n";
inline constexpr std::string_view kJpegStart = "\xff\xd8\xff";
inline constexpr std::string_view kJpegEnd = "\xff\xd9";

/// decode_picture in two steps: what FFmpeg makes of the bytes, and the frame of that.
AvFrame decode_image(const PictureOptions& options, std::string_view bytes);
Frame frame_from_picture(AvFrame picture, const PictureOptions& options, std::string_view bytes);

}  // namespace tassilo
