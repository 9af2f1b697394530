// Any bytes are read as a log or refused with an Error: without a crash, in order of log time, the same again after a
// seek, and in memory that their size bounds. The bytes are a file, or what records are made of, for hardly any others
// come past the checksums.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "bytes.h"
#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/record/internal/mcap_format.h"
#include "tassilo/record/mcap_reader.h"

namespace {

using namespace tassilo;
using mcap::Opcode;

/// Small numbers mostly, for they meet.
std::uint64_t number(Bytes& from) {
  const std::uint8_t size = from.next();
  std::uint64_t value = from.next();
  for (int i = 0; i < size - 247; ++i) value = value << 8 | from.next();
  return value;
}

std::string text(Bytes& from) {
  std::string all(static_cast<std::size_t>(from.below(8)), ' ');
  for (char& letter : all) letter = static_cast<char>(from.next());
  return all;
}

void append_to_chunk(mcap::Bytes& out, Bytes& from) {
  const int kind = from.below(8);
  const auto id = static_cast<std::uint16_t>(from.below(4));
  if (kind == 0) {
    const std::string name = text(from), data = text(from);
    append(out, mcap::Schema{id, name, "ros2msg", data});
  } else if (kind == 1) {
    const std::string topic = text(from);
    append(out, mcap::Channel{id, static_cast<std::uint16_t>(from.below(3)), topic, "cdr", {{text(from), text(from)}}});
  } else {
    const std::string data = text(from);
    append(out, mcap::Message{id, from.next(), number(from), number(from), mcap::bytes_of(data)});
  }
}

void find_extent(mcap::View records, mcap::ChunkIndex& index) {
  index.begin = index.end = 0;
  bool is_first = true;
  mcap::for_each_record(records, [&](Opcode opcode, mcap::View content, std::size_t) {
    if (opcode != Opcode::message) return true;
    const std::uint64_t time = mcap::parse_message(content)->log_time;
    index.begin = is_first ? time : std::min(index.begin, time);
    index.end = std::max(index.end, time);
    is_first = false;
    return true;
  });
}

/// A file whose records are whole, whatever is in them.
mcap::Bytes made_of(Bytes from) {
  mcap::Bytes out(mcap::kMagic.begin(), mcap::kMagic.end());
  std::vector<mcap::ChunkIndex> chunks;
  mcap::Statistics statistics;
  while (!from.empty() && from.next() != 0) {
    const int kind = from.below(8);
    if (kind < 4) {
      mcap::Bytes chunk(mcap::kRecordHead + mcap::kChunkHead);
      for (int count = from.below(16); count-- > 0;) append_to_chunk(chunk, from);
      const mcap::View records = mcap::View(chunk).subspan(mcap::kRecordHead + mcap::kChunkHead);
      mcap::Chunk head;
      head.uncompressed_crc = kind == 0 ? 0 : mcap::crc_of(records);
      put_chunk_head(chunk, head);
      mcap::ChunkIndex index;
      index.begin = number(from);
      index.end = index.begin + number(from);
      if (from.below(4) > 0) find_extent(records, index);
      index.chunk_start = out.size();
      index.chunk_length = chunk.size();
      chunks.push_back(index);
      out.insert(out.end(), chunk.begin(), chunk.end());
    } else if (kind < 6) {
      append_to_chunk(out, from);
    } else {
      const std::string name = text(from);
      append(out, mcap::Metadata{name, {{text(from), text(from)}}});
    }
  }
  append(out, mcap::DataEnd{from.below(2) == 0 ? 0 : mcap::crc_of(out)});
  mcap::Footer footer;
  if (from.below(3) > 0) {
    footer.summary_start = out.size();
    for (int count = from.below(8); count-- > 0;) append_to_chunk(out, from);
    for (const mcap::ChunkIndex& chunk : chunks) append(out, chunk);
    statistics.chunk_count = static_cast<std::uint32_t>(chunks.size());
    statistics.message_count = number(from);
    statistics.channel_count = static_cast<std::uint32_t>(from.below(3));
    append(out, statistics);
  }
  append(out, footer);
  out.insert(out.end(), mcap::kMagic.begin(), mcap::kMagic.end());
  // Some bytes are others, some are not there.
  for (int count = from.below(4); count-- > 0;)
    out[(std::size_t{from.next()} << 8 | from.next()) % out.size()] ^= std::byte{from.next()};
  out.resize(out.size() - static_cast<std::size_t>(from.next()) % out.size());
  return out;
}

using Place = std::tuple<std::int64_t, std::uint16_t, std::uint32_t, std::size_t>;

std::vector<Place> rest_of(McapReader& reader, std::size_t size) {
  std::vector<Place> all;
  while (const auto message = reader.next()) {
    expects(reader.channels().count(message->channel) > 0, "a message has its channel");
    expects(all.empty() || std::get<0>(all.back()) <= message->log_time_ns, "messages are in order of log time");
    all.emplace_back(message->log_time_ns, message->channel, message->sequence, message->data.size());
    expects(all.size() <= size, "no message is given twice");
  }
  return all;
}

void read(mcap::View file, std::int64_t from) {
  try {
    McapReader reader(file, "a.mcap");
    expects(reader.is_complete() == reader.damage().empty(), "what is damaged is said");
    reader.metadata();
    const auto channels = reader.channels();
    const std::vector<Place> all = rest_of(reader, file.size());
    expects(reader.channels() == channels, "channels are known from the beginning");
    const std::uint64_t damaged = reader.damaged_chunks();
    reader.seek(0);
    expects(rest_of(reader, file.size()) == all, "what is read again is the same");
    expects(reader.damaged_chunks() == damaged, "a damaged chunk is counted once");
    if (!all.empty()) from = std::get<0>(all[static_cast<std::size_t>(from) % all.size()]);
    reader.seek(from);
    const auto first = std::ranges::find_if(all, [&](const Place& place) { return std::get<0>(place) >= from; });
    expects(std::ranges::equal(rest_of(reader, file.size()), std::vector(first, all.end())),
            "a seek leaves out what is before");
  } catch (const Error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2 || size > 1 << 16) return 0;
  const std::int64_t from = data[1];
  if (data[0] % 4 > 0) {
    read(made_of(Bytes(data + 2, size - 2)), from);
  } else {
    mcap::Bytes file(mcap::kMagic.begin(), mcap::kMagic.end());
    const mcap::View rest = std::as_bytes(std::span(data + 2, size - 2));
    file.insert(file.end(), rest.begin(), rest.end());
    read(file, from);
    read(rest, from);
  }
  return 0;
}
