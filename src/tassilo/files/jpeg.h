#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace tassilo {

/// The bytes of a JPEG file (baseline, 4:2:0).
///
/// rgb      8-bit R, G, B interleaved, rows from the top, without padding: 3 * width * height values; at least one
/// pixel quality  1..100, as the IJG library counts it errors   none but lack of memory cost     some 5 ns a pixel;
/// safe from any thread
std::string encode_jpeg(std::span<const std::uint8_t> rgb, int width, int height, int quality,
                        const std::string& comment = "");

}  // namespace tassilo
