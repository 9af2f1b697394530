// Any bytes are an image or refused with an Error; an image that was read is written and read back equal.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/files/png.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 1 << 16) return 0;
  using namespace tassilo;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const RgbImage image = decode_png_rgb(bytes, "rgb.png");
    expects(decode_png_rgb(encode_png(image), "again.png") == image, "a written image reads back equal");
  } catch (const Error&) {
  }
  try {
    const GrayImage image = decode_png_gray(bytes, "gray.png");
    expects(decode_png_gray(encode_png(image), "again.png") == image, "a written image reads back equal");
  } catch (const Error&) {
  }
  return 0;
}
