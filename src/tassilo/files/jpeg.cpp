#include "tassilo/files/jpeg.h"

#include <jpeglib.h>
#include <cstddef>
#include <cstdio>  // before jpeglib, which wants FILE
#include <cstdlib>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"

namespace tassilo {
namespace {

/// The library reports by longjmp or exit; here by an exception, which its C code lets through only where it is
/// compiled to: so what can go wrong is excluded before it is called, and the rest is lack of memory.
[[noreturn]] void fail(j_common_ptr) { throw Error("jpeg", "cannot be encoded"); }

}  // namespace

std::string encode_jpeg(std::span<const std::uint8_t> rgb, int width, int height, int quality,
                        const std::string& comment) {
  expects(width > 0 && height > 0 && width <= JPEG_MAX_DIMENSION && height <= JPEG_MAX_DIMENSION,
          "encode_jpeg: at least one pixel, at most 65500 a side");
  expects(rgb.size() == 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
          "encode_jpeg: three values a pixel");
  constexpr std::size_t longest_comment = 65533;
  expects(comment.size() <= longest_comment, "encode_jpeg: a comment of at most 65533 bytes");
  expects(quality >= 1 && quality <= 100, "encode_jpeg: quality 1..100");
  jpeg_compress_struct encoder;
  jpeg_error_mgr errors;
  encoder.err = jpeg_std_error(&errors);
  errors.error_exit = fail;
  jpeg_create_compress(&encoder);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&encoder, &bytes, &size);
  encoder.image_width = static_cast<JDIMENSION>(width);
  encoder.image_height = static_cast<JDIMENSION>(height);
  encoder.input_components = 3;
  encoder.in_color_space = JCS_RGB;
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, quality, TRUE);
  encoder.dct_method = JDCT_IFAST;
  jpeg_start_compress(&encoder, TRUE);
  if (!comment.empty())
    jpeg_write_marker(&encoder, JPEG_COM, reinterpret_cast<const JOCTET*>(comment.data()),
                      static_cast<unsigned>(comment.size()));
  while (encoder.next_scanline < encoder.image_height) {
    auto* row = const_cast<std::uint8_t*>(rgb.data() + 3 * static_cast<std::size_t>(encoder.next_scanline) *
                                                           static_cast<std::size_t>(width));
    jpeg_write_scanlines(&encoder, &row, 1);
  }
  jpeg_finish_compress(&encoder);
  std::string result(reinterpret_cast<const char*>(bytes), size);
  jpeg_destroy_compress(&encoder);
  std::free(bytes);
  return result;
}

}  // namespace tassilo
