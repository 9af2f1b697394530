#include "tassilo/record/internal/mcap_format.h"

#include <zlib.h>

#include <algorithm>
#include <concepts>

#include "tassilo/base/contract.h"

namespace tassilo::mcap {
namespace {

template <std::unsigned_integral T>
void put_number(std::byte* at, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) at[i] = static_cast<std::byte>(value >> (8 * i));
}

/// Appends fields.
class Output {
 public:
  explicit Output(Bytes& out) : out_(out) {}

  template <std::unsigned_integral T>
  void number(T value) {
    const std::size_t at = out_.size();
    out_.resize(at + sizeof(T));
    put_number(out_.data() + at, value);
  }
  void text(std::string_view text) {
    expects(text.size() <= 0xffffffff, "mcap: a text has less than 4 GiB");
    number(static_cast<std::uint32_t>(text.size()));
    bytes(bytes_of(text));
  }
  void bytes(View bytes) { out_.insert(out_.end(), bytes.begin(), bytes.end()); }
  /// `fill` appends what a 4-byte length stands before.
  template <class Fill>
  void sized(Fill fill) {
    const std::size_t at = out_.size();
    number(std::uint32_t{0});
    fill();
    const std::size_t size = out_.size() - at - 4;
    expects(size <= 0xffffffff, "mcap: a map has less than 4 GiB");
    put_number(out_.data() + at, static_cast<std::uint32_t>(size));
  }
  void map(const McapPairs& pairs) {
    sized([&] {
      for (const auto& [key, value] : pairs) text(key), text(value);
    });
  }
  void map(std::span<const std::pair<std::uint16_t, std::uint64_t>> pairs) {
    sized([&] {
      for (const auto& [key, value] : pairs) number(key), number(value);
    });
  }

 private:
  Bytes& out_;
};

template <class Fill>
void append_record(Bytes& out, Opcode opcode, Fill fill) {
  const std::size_t at = out.size();
  out.resize(at + kRecordHead);
  out[at] = static_cast<std::byte>(opcode);
  fill(Output(out));
  put_number(out.data() + at + 1, std::uint64_t{out.size() - at - kRecordHead});
}

/// Reads fields front to back; after the end all are 0 or empty, and `whole` is false.
class Input {
 public:
  explicit Input(View bytes) : rest_(bytes) {}

  bool whole() const { return whole_; }
  bool at_end() const { return rest_.empty(); }
  View rest() const { return rest_; }

  View bytes(std::uint64_t count) {
    if (count > rest_.size()) {
      whole_ = false;
      rest_ = {};
      return {};
    }
    const View taken = rest_.first(static_cast<std::size_t>(count));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }
  template <std::unsigned_integral T>
  T number() {
    std::uint64_t value = 0;
    const View taken = bytes(sizeof(T));
    for (std::size_t i = taken.size(); i-- > 0;) value = value << 8 | std::to_integer<std::uint64_t>(taken[i]);
    return static_cast<T>(value);
  }
  void read(std::unsigned_integral auto&... fields) {
    ((fields = number<std::remove_reference_t<decltype(fields)>>()), ...);
  }
  std::string_view text() {
    const View taken = bytes(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }
  template <class Key, class Value>
  std::vector<std::pair<Key, Value>> map() {
    Input entries(bytes(number<std::uint32_t>()));
    std::vector<std::pair<Key, Value>> pairs;
    while (!entries.at_end()) {
      Key key(entries.field<Key>());
      Value value(entries.field<Value>());
      if (entries.whole()) pairs.emplace_back(std::move(key), std::move(value));
    }
    whole_ = whole_ && entries.whole();
    return pairs;
  }
  template <class Record>
  std::optional<Record> if_whole(Record record) const {
    return whole_ ? std::optional<Record>(std::move(record)) : std::nullopt;
  }

 private:
  template <class T>
  auto field() {
    if constexpr (std::unsigned_integral<T>) {
      return number<T>();
    } else {
      return text();
    }
  }

  View rest_;
  bool whole_ = true;
};

}  // namespace

void append(Bytes& out, const Header& header) {
  append_record(out, Opcode::header, [&](Output to) { to.text(header.profile), to.text(header.library); });
}

void append(Bytes& out, const Footer& footer) {
  append_record(out, Opcode::footer, [&](Output to) {
    to.number(footer.summary_start);
    to.number(footer.summary_offset_start);
    to.number(footer.summary_crc);
  });
}

void append(Bytes& out, const Schema& schema) {
  append_record(out, Opcode::schema, [&](Output to) {
    to.number(schema.id);
    to.text(schema.name);
    to.text(schema.encoding);
    to.text(schema.data);
  });
}

void append(Bytes& out, const Channel& channel) {
  append_record(out, Opcode::channel, [&](Output to) {
    to.number(channel.id);
    to.number(channel.schema_id);
    to.text(channel.topic);
    to.text(channel.message_encoding);
    to.map(channel.metadata);
  });
}

void append(Bytes& out, const Message& message) {
  append_record(out, Opcode::message, [&](Output to) {
    to.number(message.channel);
    to.number(message.sequence);
    to.number(message.log_time);
    to.number(message.publish_time);
    to.bytes(message.data);
  });
}

void append(Bytes& out, const MessageIndex& index) {
  append_record(out, Opcode::message_index, [&](Output to) {
    to.number(index.channel);
    to.sized([&] {
      for (const auto& [time, place] : index.entries) to.number(time), to.number(place);
    });
  });
}

void append(Bytes& out, const ChunkIndex& index) {
  append_record(out, Opcode::chunk_index, [&](Output to) {
    to.number(index.begin);
    to.number(index.end);
    to.number(index.chunk_start);
    to.number(index.chunk_length);
    to.map(index.message_index_offsets);
    to.number(index.message_index_length);
    to.text(index.compression);
    to.number(index.compressed_size);
    to.number(index.uncompressed_size);
  });
}

void append(Bytes& out, const Statistics& statistics) {
  append_record(out, Opcode::statistics, [&](Output to) {
    to.number(statistics.message_count);
    to.number(statistics.schema_count);
    to.number(statistics.channel_count);
    to.number(statistics.attachment_count);
    to.number(statistics.metadata_count);
    to.number(statistics.chunk_count);
    to.number(statistics.begin);
    to.number(statistics.end);
    to.map(statistics.channel_message_counts);
  });
}

void append(Bytes& out, const Metadata& metadata) {
  append_record(out, Opcode::metadata, [&](Output to) { to.text(metadata.name), to.map(metadata.pairs); });
}

void append(Bytes& out, const MetadataIndex& index) {
  append_record(out, Opcode::metadata_index, [&](Output to) {
    to.number(index.offset);
    to.number(index.length);
    to.text(index.name);
  });
}

void append(Bytes& out, const SummaryOffset& offset) {
  append_record(out, Opcode::summary_offset, [&](Output to) {
    to.number(static_cast<std::uint8_t>(offset.group));
    to.number(offset.start);
    to.number(offset.length);
  });
}

void append(Bytes& out, const DataEnd& end) {
  append_record(out, Opcode::data_end, [&](Output to) { to.number(end.data_crc); });
}

void put_chunk_head(Bytes& out, const Chunk& chunk) {
  expects(out.size() >= kRecordHead + kChunkHead && chunk.compression.empty(),
          "mcap: a chunk has a place for its head");
  const std::uint64_t size = out.size() - kRecordHead - kChunkHead;
  out[0] = static_cast<std::byte>(Opcode::chunk);
  put_number(&out[1], std::uint64_t{kChunkHead + size});
  put_number(&out[9], chunk.begin);
  put_number(&out[17], chunk.end);
  put_number(&out[25], size);
  put_number(&out[33], chunk.uncompressed_crc);
  put_number(&out[37], std::uint32_t{0});  // the name of no compression
  put_number(&out[41], size);
}

std::optional<Footer> parse_footer(View content) {
  Input from(content);
  Footer footer;
  from.read(footer.summary_start, footer.summary_offset_start, footer.summary_crc);
  return from.if_whole(footer);
}

std::optional<Schema> parse_schema(View content) {
  Input from(content);
  Schema schema;
  from.read(schema.id);
  schema.name = from.text();
  schema.encoding = from.text();
  schema.data = from.text();
  return from.if_whole(schema);
}

std::optional<Channel> parse_channel(View content) {
  Input from(content);
  Channel channel;
  from.read(channel.id, channel.schema_id);
  channel.topic = from.text();
  channel.message_encoding = from.text();
  channel.metadata = from.map<std::string, std::string>();
  return from.if_whole(std::move(channel));
}

std::optional<Message> parse_message(View content) {
  Input from(content);
  Message message;
  from.read(message.channel, message.sequence, message.log_time, message.publish_time);
  message.data = from.rest();
  return from.if_whole(message);
}

std::optional<Chunk> parse_chunk(View content) {
  Input from(content);
  Chunk chunk;
  from.read(chunk.begin, chunk.end, chunk.uncompressed_size, chunk.uncompressed_crc);
  chunk.compression = from.text();
  chunk.records = from.bytes(from.number<std::uint64_t>());
  if (chunk.compression.empty() && chunk.uncompressed_size != chunk.records.size()) return std::nullopt;
  return from.if_whole(chunk);
}

std::optional<ChunkIndex> parse_chunk_index(View content) {
  Input from(content);
  ChunkIndex index;
  from.read(index.begin, index.end, index.chunk_start, index.chunk_length);
  index.message_index_offsets = from.map<std::uint16_t, std::uint64_t>();
  from.read(index.message_index_length);
  index.compression = from.text();
  from.read(index.compressed_size, index.uncompressed_size);
  return from.if_whole(std::move(index));
}

std::optional<Statistics> parse_statistics(View content) {
  Input from(content);
  Statistics all;
  from.read(all.message_count, all.schema_count, all.channel_count, all.attachment_count, all.metadata_count,
            all.chunk_count, all.begin, all.end);
  all.channel_message_counts = from.map<std::uint16_t, std::uint64_t>();
  return from.if_whole(std::move(all));
}

std::optional<Metadata> parse_metadata(View content) {
  Input from(content);
  Metadata metadata;
  metadata.name = from.text();
  metadata.pairs = from.map<std::string, std::string>();
  return from.if_whole(std::move(metadata));
}

std::optional<MetadataIndex> parse_metadata_index(View content) {
  Input from(content);
  MetadataIndex index;
  from.read(index.offset, index.length);
  index.name = from.text();
  return from.if_whole(index);
}

std::optional<DataEnd> parse_data_end(View content) {
  Input from(content);
  DataEnd end;
  from.read(end.data_crc);
  return from.if_whole(end);
}

RecordHead parse_head(std::span<const std::byte, kRecordHead> head) {
  Input from(head);
  RecordHead record;
  record.opcode = static_cast<Opcode>(from.number<std::uint8_t>());
  record.length = from.number<std::uint64_t>();
  return record;
}

std::uint32_t crc_of(View bytes, std::uint32_t before) {
  if (bytes.empty()) return before;  // zlib begins anew at a null pointer
  return static_cast<std::uint32_t>(crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace tassilo::mcap
