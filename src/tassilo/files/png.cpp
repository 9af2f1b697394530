#include "tassilo/files/png.h"

#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/files/atomic_file.h"
#include "tassilo/files/text.h"

// libpng reports errors by longjmp, which must not pass over objects with destructors. So each call into libpng is a
// step: a plain function over one of the structs below, which guarded() runs under setjmp. All memory belongs to the
// structs.

namespace tassilo {
namespace {

constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;
constexpr png_uint_32 kMaxSide = 1 << 20;
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 31;
/// Deflate never gives more than 1032 bytes for one.
constexpr std::uint64_t kMaxCompression = 1032;

struct Message {
  std::array<char, 128> text{};
};

void keep_message(png_structp png, png_const_charp text) {
  auto* message = static_cast<Message*>(png_get_error_ptr(png));
  std::snprintf(message->text.data(), message->text.size(), "%s", text);
  png_longjmp(png, 1);
}
void ignore_warning(png_structp, png_const_charp) {}

/// Runs one step; false when libpng gave up in it.
template <class State>
bool guarded(State& state, void (*step)(State&)) {
  if (setjmp(png_jmpbuf(state.png))) return false;
  step(state);
  return true;
}

struct Reader {
  std::string_view bytes;
  std::size_t position = 0;
  Message message;
  png_structp png = nullptr;
  png_infop info = nullptr;
  bool as_rgb = false;
  int width = 0, height = 0, bit_depth = 0, color_type = 0;
  std::vector<std::uint8_t> pixels;
  std::vector<png_bytep> rows;

  explicit Reader(std::string_view data) : bytes(data) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message, &keep_message, &ignore_warning);
    info = png ? png_create_info_struct(png) : nullptr;
  }
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
};

void give_bytes(png_structp png, png_bytep out, std::size_t count) {
  auto* reader = static_cast<Reader*>(png_get_io_ptr(png));
  if (count > reader->bytes.size() - reader->position) png_error(png, "it ends too early");
  std::memcpy(out, reader->bytes.data() + reader->position, count);
  reader->position += count;
}

void read_header(Reader& reader) {
  png_set_read_fn(reader.png, &reader, &give_bytes);
  png_set_user_limits(reader.png, kMaxSide, kMaxSide);
  png_set_chunk_malloc_max(reader.png, 1 << 24);
  png_set_chunk_cache_max(reader.png, 128);
  png_read_info(reader.png, reader.info);
  reader.width = static_cast<int>(png_get_image_width(reader.png, reader.info));
  reader.height = static_cast<int>(png_get_image_height(reader.png, reader.info));
  reader.bit_depth = png_get_bit_depth(reader.png, reader.info);
  reader.color_type = png_get_color_type(reader.png, reader.info);
}

void ask_for_rgb(Reader& reader) {
  png_set_expand(reader.png);
  png_set_scale_16(reader.png);
  png_set_strip_alpha(reader.png);
  png_set_gray_to_rgb(reader.png);
}

void start_rows(Reader& reader) {
  if (reader.as_rgb) ask_for_rgb(reader);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
}

void read_rows(Reader& reader) {
  png_read_image(reader.png, reader.rows.data());
  png_read_end(reader.png, nullptr);
}

std::string kind_of(const Reader& reader) {
  std::string color = "RGB";
  if (reader.color_type & PNG_COLOR_MASK_PALETTE)
    color = "palette";
  else if (!(reader.color_type & PNG_COLOR_MASK_COLOR))
    color = "gray";
  return std::to_string(reader.bit_depth) + "-bit " + color +
         (reader.color_type & PNG_COLOR_MASK_ALPHA ? " with transparency" : "");
}

/// What the header promises must be possible for a file of this size: no memory is taken on a mere claim.
void check_size(const Reader& reader, const std::string& name) {
  const std::string size = std::to_string(reader.width) + "x" + std::to_string(reader.height);
  if (std::int64_t{reader.width} * reader.height > kMaxPixels)
    throw Error(name, "has " + size + " pixels, must have at most " + std::to_string(kMaxPixels));
  const std::uint64_t packed = png_get_rowbytes(reader.png, reader.info) * static_cast<std::uint64_t>(reader.height);
  if (packed / kMaxCompression > reader.bytes.size())
    throw Error(name,
                "has " + size + " pixels in " + std::to_string(reader.bytes.size()) + " bytes, it is cut or broken");
}

template <class Image>
Image decode(std::string_view bytes, const std::string& name, int channels) {
  if (bytes.size() < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) != 0)
    throw Error(name, "is no PNG file");
  Reader reader(bytes);
  expects(reader.info != nullptr, "libpng has memory to start");
  reader.as_rgb = channels == 3;
  const auto broken = [&] { throw Error(name, std::string("is a broken PNG file: ") + reader.message.text.data()); };
  if (!guarded(reader, read_header)) broken();
  if (channels == 1 && (reader.color_type != PNG_COLOR_TYPE_GRAY || reader.bit_depth != 8))
    throw Error(name, "is " + kind_of(reader) + ", must be 8-bit gray");
  check_size(reader, name);
  if (!guarded(reader, start_rows)) broken();
  const std::size_t row_bytes = static_cast<std::size_t>(reader.width) * static_cast<std::size_t>(channels);
  expects(png_get_rowbytes(reader.png, reader.info) == row_bytes, "libpng gives the bytes that were asked for");
  reader.pixels.resize(row_bytes * static_cast<std::size_t>(reader.height));
  for (int r = 0; r < reader.height; ++r)
    reader.rows.push_back(reader.pixels.data() + row_bytes * static_cast<std::size_t>(r));
  if (!guarded(reader, read_rows)) broken();
  return Image{reader.width, reader.height, std::move(reader.pixels)};
}

struct Writer {
  Message message;
  png_structp png = nullptr;
  png_infop info = nullptr;
  int width = 0, height = 0, channels = 0;
  const std::uint8_t* pixels = nullptr;
  std::string bytes;

  Writer() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &message, &keep_message, &ignore_warning);
    info = png ? png_create_info_struct(png) : nullptr;
  }
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
};

void take_bytes(png_structp png, png_bytep data, std::size_t count) {
  static_cast<Writer*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<const char*>(data), count);
}
void flush_nothing(png_structp) {}

void write_image(Writer& writer) {
  png_set_write_fn(writer.png, &writer, &take_bytes, &flush_nothing);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(writer.width), static_cast<png_uint_32>(writer.height),
               8, writer.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  for (int r = 0; r < writer.height; ++r)
    png_write_row(writer.png, writer.pixels + static_cast<std::ptrdiff_t>(r) * writer.width * writer.channels);
  png_write_end(writer.png, nullptr);
}

std::string encode(int width, int height, int channels, const std::vector<std::uint8_t>& pixels) {
  expects(width > 0 && height > 0 && std::int64_t{width} * height <= kMaxPixels, "a PNG has 1 to 2^28 pixels");
  expects(pixels.size() == static_cast<std::size_t>(std::int64_t{width} * height * channels),
          "a PNG has all its pixels");
  Writer writer;
  expects(writer.info != nullptr, "libpng has memory to start");
  writer.width = width;
  writer.height = height;
  writer.channels = channels;
  writer.pixels = pixels.data();
  expects(guarded(writer, write_image), "libpng writes a valid image");
  return std::move(writer.bytes);
}

}  // namespace

GrayImage decode_png_gray(std::string_view bytes, const std::string& name) { return decode<GrayImage>(bytes, name, 1); }
RgbImage decode_png_rgb(std::string_view bytes, const std::string& name) { return decode<RgbImage>(bytes, name, 3); }
GrayImage read_png_gray(const std::filesystem::path& file) {
  return decode_png_gray(read_text(file, kMaxFileBytes), file.string());
}
RgbImage read_png_rgb(const std::filesystem::path& file) {
  return decode_png_rgb(read_text(file, kMaxFileBytes), file.string());
}

std::string encode_png(const GrayImage& image) { return encode(image.width, image.height, 1, image.pixels); }
std::string encode_png(const RgbImage& image) { return encode(image.width, image.height, 3, image.pixels); }
void write_png_gray(const std::filesystem::path& file, const GrayImage& image) {
  write_atomically(file, encode_png(image));
}
void write_png_rgb(const std::filesystem::path& file, const RgbImage& image) {
  write_atomically(file, encode_png(image));
}

}  // namespace tassilo
