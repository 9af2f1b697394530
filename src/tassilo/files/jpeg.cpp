#include "tassilo/files/jpeg.h"

#include <jpeglib.h>
#include <csetjmp>
#include <cstddef>
#include <cstdio>  // before jpeglib, which wants FILE
#include <cstdlib>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"

namespace tassilo {
namespace {

/// The library's errors, and where to go on after one: no exception may pass its C code.
struct Errors {
  jpeg_error_mgr manager;  ///< First: the library knows this part only.
  jmp_buf after;
};
[[noreturn]] void fail(j_common_ptr encoder) { longjmp(reinterpret_cast<Errors*>(encoder->err)->after, 1); }

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
  Errors errors;
  encoder.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = fail;
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_create_compress(&encoder);
  if (setjmp(errors.after) != 0) {
    jpeg_destroy_compress(&encoder);  // its output is lost: only it knows where that was
    throw Error("jpeg", "cannot be encoded");
  }
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
