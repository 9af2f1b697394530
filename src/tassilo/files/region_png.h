#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "tassilo/region/region.h"

namespace tassilo {

/// The pixels of a mask that are not 0. 8-bit gray PNGs only, at most 32767 pixels wide and high, as regions are 16
/// bit. Throws Error(name, reason).
Region decode_png_region(std::string_view bytes, const std::string& name);
Region read_png_region(const std::filesystem::path& file);

/// A mask of the window, 255 in the region and 0 elsewhere, as a PNG; what lies outside the window is cut, and the
/// window's top-left pixel becomes (0, 0). The window has at least one pixel and at most 2^28. Written atomically.
/// HALCON `region_to_bin` and `write_image`.
std::string encode_png_region(const Region& region, const PixelBox& window);
void write_png_region(const std::filesystem::path& file, const Region& region, const PixelBox& window);

}  // namespace tassilo
