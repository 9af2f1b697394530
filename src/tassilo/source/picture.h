#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "tassilo/image/frame.h"

namespace tassilo {

struct PictureOptions {
  std::string name;                                 ///< For messages.
  ColorRange images_range = ColorRange::limited;    ///< What RGB, gray and palettes of PNG become.
  std::int64_t max_pixels = std::int64_t{1} << 30;  ///< Larger ones are refused before memory is taken for them. >= 1
};

/// The bytes of one PNG or JPEG file as a frame, as FrameSource tells of images. Index and time are left to the caller.
///
/// The bytes may be anybody's. Safe from any thread.
/// Throws Error(name, ...) when they are no such file, or one that is damaged, cut short or too large.
Frame decode_picture(std::span<const std::uint8_t> file, const PictureOptions& options);

}  // namespace tassilo
