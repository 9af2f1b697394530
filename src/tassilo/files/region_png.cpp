#include "tassilo/files/region_png.h"

#include <limits>

#include "tassilo/base/error.h"
#include "tassilo/files/png.h"
#include "tassilo/region/raster.h"

namespace tassilo {
namespace {

Region region_of(const GrayImage& image, const std::string& name) {
  constexpr int kMostSide = std::numeric_limits<std::int16_t>::max();
  if (image.width > kMostSide || image.height > kMostSide)
    throw Error(name, "is a mask of " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                          " pixels, must be at most " + std::to_string(kMostSide) + " wide and high");
  return region_where({image.pixels.data(), image.width, image.height, image.width},
                      [](int byte) { return byte != 0; });
}

GrayImage image_of(const Region& region, const PixelBox& window) {
  return {window.width(), window.height(), to_mask(region, window)};
}

}  // namespace

Region decode_png_region(std::string_view bytes, const std::string& name) {
  return region_of(decode_png_gray(bytes, name), name);
}
Region read_png_region(const std::filesystem::path& file) { return region_of(read_png_gray(file), file.string()); }

std::string encode_png_region(const Region& region, const PixelBox& window) {
  return encode_png(image_of(region, window));
}
void write_png_region(const std::filesystem::path& file, const Region& region, const PixelBox& window) {
  write_png_gray(file, image_of(region, window));
}

}  // namespace tassilo
