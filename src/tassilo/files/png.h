#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tassilo {

/// 8-bit values, rows from the top, without padding: pixel (c, r) is pixels[r * width + c].
struct GrayImage {
  int width = 0, height = 0;  ///< [px]
  std::vector<std::uint8_t> pixels;
  friend bool operator==(const GrayImage&, const GrayImage&) = default;
};

/// 8-bit R, G, B interleaved, rows from the top: pixel (c, r) begins at pixels[3 * (r * width + c)].
struct RgbImage {
  int width = 0, height = 0;  ///< [px]
  std::vector<std::uint8_t> pixels;
  friend bool operator==(const RgbImage&, const RgbImage&) = default;
};

/// Values as stored, for label maps and color tables: 8-bit gray only, any other kind of PNG is refused. Images have at
/// most 2^28 pixels. Throws Error(name, reason) also for broken or cut data: there is no half image.
GrayImage decode_png_gray(std::string_view bytes, const std::string& name);
GrayImage read_png_gray(const std::filesystem::path& file);

/// Any PNG as 8-bit RGB: gray and palettes expanded, 16 bit rounded, transparency ignored (colors as stored), gamma and
/// color profiles not applied. Bounds and errors as above.
RgbImage decode_png_rgb(std::string_view bytes, const std::string& name);
RgbImage read_png_rgb(const std::filesystem::path& file);

/// The bytes of a PNG file; reading gives the same image. An image has at least one pixel.
std::string encode_png(const GrayImage& image);
std::string encode_png(const RgbImage& image);
/// Written atomically.
void write_png_gray(const std::filesystem::path& file, const GrayImage& image);
void write_png_rgb(const std::filesystem::path& file, const RgbImage& image);

}  // namespace tassilo
