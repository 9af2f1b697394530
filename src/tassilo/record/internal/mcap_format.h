#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tassilo/record/mcap_channel.h"

// The grammar of MCAP files (https://mcap.dev/spec), version 0, for writer and reader:
//
//   magic, header, data: {schema, channel, message, chunk, message index, metadata, ..}, data end,
//   summary: {schema, channel, statistics, chunk index, metadata index, ..}, summary offsets, footer, magic
//
// A record is opcode (1 byte), length of the content (8) and content. Numbers are little-endian; a text is its length
// (4) and its bytes; a map its length in bytes (4) and its keys and values in turns. Contents may grow at their end in
// later versions, so what follows the fields that are known here is passed over.
//
// To add a record: its opcode and struct here, `append` and, if it is read, `parse_..` in the .cpp.
namespace tassilo::mcap {

using Bytes = std::vector<std::byte>;
using View = std::span<const std::byte>;

enum class Opcode : std::uint8_t {
  header = 1,
  footer,
  schema,
  channel,
  message,
  chunk,
  message_index,
  chunk_index,
  attachment,
  attachment_index,
  statistics,
  metadata,
  metadata_index,
  summary_offset,
  data_end,
};

inline constexpr std::array<std::byte, 8> kMagic{std::byte{0x89}, std::byte{'M'}, std::byte{'C'},  std::byte{'A'},
                                                 std::byte{'P'},  std::byte{'0'}, std::byte{'\r'}, std::byte{'\n'}};
inline constexpr std::size_t kRecordHead = 1 + 8;        ///< Opcode and length.
inline constexpr std::size_t kMessageHead = 2 + 4 + 16;  ///< All of a message but its data.
inline constexpr std::size_t kFooter = 8 + 8 + 4;        ///< Content of the footer.
inline constexpr std::size_t kChunkHead =
    8 + 8 + 8 + 4 + 4 + 8;  ///< Of a chunk without compression, before its records.
/// What must be in memory at once is not longer; longer records are refused. [bytes]
inline constexpr std::uint64_t kMaxRecord = std::uint64_t{256} << 20;
/// Schemas, channels and notes are not longer: what is made of them takes several times their bytes. [bytes]
inline constexpr std::uint64_t kMaxDescription = std::uint64_t{16} << 20;

// The structs refer to the bytes they were read from or the texts they are written from. Times are nanoseconds.

struct Header {
  std::string_view profile{}, library{};
};
struct Footer {
  std::uint64_t summary_start = 0, summary_offset_start = 0;  ///< Places in the file; 0: there is none.
  std::uint32_t summary_crc = 0;  ///< From summary_start to the field before this one; 0: not given.
};
struct Schema {
  std::uint16_t id = 0;  ///< Not 0.
  std::string_view name{}, encoding{}, data{};
};
struct Channel {
  std::uint16_t id = 0, schema_id = 0;  ///< Schema 0: none.
  std::string_view topic{}, message_encoding{};
  McapPairs metadata{};
};
struct Message {
  std::uint16_t channel = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0, publish_time = 0;
  View data{};
};
struct Chunk {
  std::uint64_t begin = 0, end = 0;  ///< Earliest and latest log time; 0 without messages.
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  ///< 0: not given.
  std::string_view compression{};      ///< Empty: none.
  View records{};
};
struct MessageIndex {
  std::uint16_t channel = 0;
  std::span<const std::pair<std::uint64_t, std::uint64_t>> entries{};  ///< Log time, place in the chunk's records.
};
struct ChunkIndex {
  std::uint64_t begin = 0, end = 0, chunk_start = 0, chunk_length = 0;  ///< chunk_length with opcode and length.
  std::vector<std::pair<std::uint16_t, std::uint64_t>> message_index_offsets{};
  std::uint64_t message_index_length = 0;
  std::string_view compression{};
  std::uint64_t compressed_size = 0, uncompressed_size = 0;
};
struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0, attachment_count = 0, metadata_count = 0, chunk_count = 0;
  std::uint64_t begin = 0, end = 0;
  std::vector<std::pair<std::uint16_t, std::uint64_t>> channel_message_counts{};
};
struct Metadata {
  std::string_view name{};
  McapPairs pairs{};
};
struct MetadataIndex {
  std::uint64_t offset = 0, length = 0;  ///< length with opcode and length.
  std::string_view name{};
};
struct SummaryOffset {
  Opcode group = Opcode::schema;
  std::uint64_t start = 0, length = 0;
};
struct DataEnd {
  std::uint32_t data_crc = 0;  ///< Of all that comes before this record; 0: not given.
};

/// Appends the whole record, opcode and length first.
void append(Bytes& out, const Header&);
void append(Bytes& out, const Footer&);
void append(Bytes& out, const Schema&);
void append(Bytes& out, const Channel&);
void append(Bytes& out, const Message&);
void append(Bytes& out, const MessageIndex&);
void append(Bytes& out, const ChunkIndex&);
void append(Bytes& out, const Statistics&);
void append(Bytes& out, const Metadata&);
void append(Bytes& out, const MetadataIndex&);
void append(Bytes& out, const SummaryOffset&);
void append(Bytes& out, const DataEnd&);

/// Overwrites the first kRecordHead + kChunkHead bytes of `out`; what follows them are the records of `chunk`, of which
/// the other fields are taken.
void put_chunk_head(Bytes& out, const Chunk& chunk);

/// From the content of a record; nothing when the content is too short for it or contradicts itself.
std::optional<Footer> parse_footer(View content);
std::optional<Schema> parse_schema(View content);
std::optional<Channel> parse_channel(View content);
std::optional<Message> parse_message(View content);
std::optional<Chunk> parse_chunk(View content);
std::optional<ChunkIndex> parse_chunk_index(View content);
std::optional<Statistics> parse_statistics(View content);
std::optional<Metadata> parse_metadata(View content);
std::optional<MetadataIndex> parse_metadata_index(View content);
std::optional<DataEnd> parse_data_end(View content);

/// The beginning of a record, of which the content need not be there.
struct RecordHead {
  Opcode opcode{};
  std::uint64_t length = 0;  ///< Of the content, as the file says.
};
RecordHead parse_head(std::span<const std::byte, kRecordHead> head);

/// CRC-32 of zlib; `before` is that of the bytes before these.
std::uint32_t crc_of(View bytes, std::uint32_t before = 0);

inline View bytes_of(std::string_view text) { return std::as_bytes(std::span(text.data(), text.size())); }

/// Calls `take(opcode, content, place of the record)` for each record, until it gives false.
/// True when `bytes` are whole records, and all were taken.
template <class Take>
bool for_each_record(View bytes, Take take) {
  for (std::size_t at = 0; at < bytes.size();) {
    if (bytes.size() - at < kRecordHead) return false;
    const RecordHead head = parse_head(bytes.subspan(at).first<kRecordHead>());
    if (head.length > bytes.size() - at - kRecordHead) return false;
    const View content = bytes.subspan(at + kRecordHead, static_cast<std::size_t>(head.length));
    if (!take(head.opcode, content, at)) return false;
    at += kRecordHead + content.size();
  }
  return true;
}

}  // namespace tassilo::mcap
