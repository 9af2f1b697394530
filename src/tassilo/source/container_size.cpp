#include "tassilo/source/internal/container_size.h"

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <string_view>

namespace tassilo {
namespace {

/// Big- and little-endian numbers at places of a file; nothing beyond its end.
class Bytes {
 public:
  explicit Bytes(const std::string& path) : file_(path, std::ios::binary | std::ios::ate) {
    if (file_) size_ = file_.tellg();
  }
  std::int64_t size() const { return size_; }

  std::optional<std::uint64_t> big(std::int64_t at, int count) { return number(at, count, true); }
  std::optional<std::uint64_t> little(std::int64_t at, int count) { return number(at, count, false); }
  bool has(std::int64_t at, std::string_view tag) {
    std::string read(tag.size(), '\0');
    return at + static_cast<std::int64_t>(tag.size()) <= size_ && file_.seekg(at) &&
           file_.read(read.data(), static_cast<std::streamsize>(read.size())) && read == tag;
  }

 private:
  std::optional<std::uint64_t> number(std::int64_t at, int count, bool big_endian) {
    std::array<char, 8> bytes{};
    if (at < 0 || at + count > size_ || !file_.seekg(at) || !file_.read(bytes.data(), count)) return std::nullopt;
    if (!big_endian) std::reverse(bytes.begin(), bytes.begin() + count);
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[static_cast<std::size_t>(i)]);
    return value;
  }

  std::ifstream file_;
  std::int64_t size_ = 0;
};

/// A Matroska element's size field (RFC 8794, 4): the leading zeros tell its length, all ones mean unknown.
struct VariableInt {
  std::int64_t length = 0;
  std::optional<std::int64_t> value;
};
std::optional<VariableInt> variable_int(Bytes& bytes, std::int64_t at) {
  const auto first = bytes.big(at, 1);
  if (!first || *first == 0) return std::nullopt;
  const int length = std::countl_zero(static_cast<std::uint8_t>(*first)) + 1;
  const auto all = bytes.big(at, length);
  if (!all) return std::nullopt;
  const std::uint64_t mask = (std::uint64_t{1} << (7 * length)) - 1;
  VariableInt result{length, static_cast<std::int64_t>(*all & mask)};
  if ((*all & mask) == mask) result.value.reset();
  return result;
}

/// End of the Matroska segment; nothing when unknown.
std::optional<std::int64_t> matroska_end(Bytes& bytes) {
  const auto header = variable_int(bytes, 4);
  if (!header || !header->value) return std::nullopt;
  const std::int64_t segment = 4 + header->length + *header->value;
  if (!bytes.has(segment, "\x18\x53\x80\x67")) return std::nullopt;
  const auto size = variable_int(bytes, segment + 4);
  if (!size || !size->value) return std::nullopt;
  return segment + 4 + size->length + *size->value;
}

/// End of the last top-level box (ISO 14496-12, 4.2).
std::optional<std::int64_t> box_end(Bytes& bytes) {
  std::int64_t at = 0;
  while (at < bytes.size()) {
    const auto small = bytes.big(at, 4);
    if (!small) return at + 8;
    std::int64_t size = static_cast<std::int64_t>(*small);
    if (size == 0) return std::nullopt;  // to the end of the file, wherever that is
    if (size == 1) {
      const auto large = bytes.big(at + 8, 8);
      if (!large) return at + 16;
      size = static_cast<std::int64_t>(std::min<std::uint64_t>(*large, std::uint64_t{1} << 62));
    }
    if (size < 8) return std::nullopt;
    at += size;
  }
  return at;
}

/// End of the last RIFF chunk; large AVI files have several.
std::optional<std::int64_t> riff_end(Bytes& bytes) {
  std::int64_t at = 0;
  while (bytes.has(at, "RIFF")) {
    const auto size = bytes.little(at + 4, 4);
    if (!size || *size == 0) return std::nullopt;  // a recording that was never finished
    at += 8 + static_cast<std::int64_t>(*size);
  }
  return at;
}

}  // namespace

std::int64_t missing_bytes(const std::string& path) {
  Bytes bytes(path);
  std::optional<std::int64_t> end;
  if (bytes.has(0, "\x1a\x45\xdf\xa3"))
    end = matroska_end(bytes);
  else if (bytes.has(4, "ftyp"))
    end = box_end(bytes);
  else if (bytes.has(0, "RIFF"))
    end = riff_end(bytes);
  return end ? std::max<std::int64_t>(0, *end - bytes.size()) : 0;
}

}  // namespace tassilo
