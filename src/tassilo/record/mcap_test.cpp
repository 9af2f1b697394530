#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <random>

#include "tassilo/base/error.h"
#include "tassilo/files/test_folder.h"
#include "tassilo/record/internal/mcap_format.h"
#include "tassilo/record/mcap_reader.h"
#include "tassilo/record/mcap_writer.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;
using mcap::Bytes;
using testing::HasSubstr;

constexpr std::int64_t kBegin = 1'764'288'000'000'000'000;  ///< A day in November 2025. [ns]

struct Logged {
  std::uint16_t channel = 0;
  std::int64_t log_time = 0, publish_time = 0;
  std::uint32_t sequence = 0;
  Bytes data;

  bool operator==(const Logged&) const = default;
};
/// What a failed test shows.
std::ostream& operator<<(std::ostream& out, const Logged& message) {
  return out << "channel " << message.channel << " #" << message.sequence << " at " << message.log_time << ", "
             << message.data.size() << " bytes";
}

Logged copy_of(const McapMessage& message) {
  return {message.channel, message.log_time_ns, message.publish_time_ns, message.sequence,
          Bytes(message.data.begin(), message.data.end())};
}

/// All that the reader gives from here on.
std::vector<Logged> rest_of(McapReader& reader) {
  std::vector<Logged> all;
  while (const auto message = reader.next()) all.push_back(copy_of(*message));
  return all;
}

std::vector<Logged> by_time(std::vector<Logged> messages) {
  std::ranges::stable_sort(messages, {}, &Logged::log_time);
  return messages;
}

Bytes bytes_in(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const mcap::View view = mcap::bytes_of(text);
  return {view.begin(), view.end()};
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

McapChannel channel_named(const std::string& topic, const std::string& schema = "std_msgs/msg/Header") {
  return {.topic = topic, .schema_name = schema, .definition = "string " + schema, .metadata = {{"offered_qos", ""}}};
}

class Random {
 public:
  explicit Random(int seed) : generator_(static_cast<unsigned>(seed)) {}
  std::int64_t below(std::int64_t n) { return std::uniform_int_distribution<std::int64_t>(0, n - 1)(generator_); }
  Bytes bytes(std::int64_t count) {
    Bytes all(static_cast<std::size_t>(count));
    for (std::byte& byte : all) byte = static_cast<std::byte>(below(256));
    return all;
  }

 private:
  std::mt19937 generator_;
};

/// Writes a message and gives what must be read.
Logged write(McapWriter& writer, std::vector<std::uint32_t>& sequences, Logged message) {
  sequences.resize(std::max<std::size_t>(sequences.size(), message.channel + 1u));
  message.sequence = sequences[message.channel]++;
  writer.write(message.channel, message.log_time, message.publish_time, message.data);
  return message;
}

/// A small log of two channels with messages in several chunks, as it was written.
struct SmallLog {
  Bytes bytes;
  std::vector<Logged> messages;
  std::vector<std::size_t> chunk_begins, chunk_ends;
  std::vector<std::size_t> chunk_messages;  ///< Messages up to there.
};

SmallLog small_log(const TestFolder& folder) {
  SmallLog log;
  McapWriter writer(folder / "small.mcap", {.chunk_bytes = 200});
  const std::uint16_t ball = writer.add_channel(channel_named("/ball")),
                      pose = writer.add_channel(channel_named("/pose"));
  writer.add_metadata("robot", {{"id", "3"}});
  std::vector<std::uint32_t> sequences;
  Random random(1);
  for (int i = 0; i < 12; ++i)
    log.messages.push_back(
        write(writer, sequences,
              {i % 3 == 0 ? pose : ball, kBegin + 1000 * i, kBegin + 1000 * i - 7, 0, random.bytes(random.below(60))}));
  writer.finish();
  log.bytes = bytes_in(folder / "small.mcap");
  std::size_t messages = 0;
  mcap::for_each_record(mcap::View(log.bytes).subspan(8, log.bytes.size() - 16),
                        [&](mcap::Opcode opcode, mcap::View content, std::size_t at) {
                          if (opcode != mcap::Opcode::chunk) return true;
                          mcap::for_each_record(mcap::parse_chunk(content)->records,
                                                [&](mcap::Opcode inner, mcap::View, std::size_t) {
                                                  messages += inner == mcap::Opcode::message ? 1 : 0;
                                                  return true;
                                                });
                          log.chunk_begins.push_back(8 + at);
                          log.chunk_ends.push_back(8 + at + mcap::kRecordHead + content.size());
                          log.chunk_messages.push_back(messages);
                          return true;
                        });
  fs::remove(folder / "small.mcap");
  return log;
}

TEST(Mcap, GivesBackEveryMessageInOrderOfLogTime) {
  const TestFolder folder;
  for (int seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const fs::path file = folder / (std::to_string(seed) + ".mcap");
    const auto chunk_bytes = static_cast<std::size_t>(1 + random.below(seed % 2 == 0 ? 300 : 20000));
    McapWriter writer(file, {.chunk_bytes = chunk_bytes, .chunk_seconds = seed % 3 == 0 ? 1e-6 : 1});
    std::vector<McapChannel> channels(1);
    std::vector<std::uint32_t> sequences;
    std::vector<Logged> written;
    const std::int64_t disorder = seed % 4 == 0 ? 1 : 20'000;
    for (int i = 0; i < 200; ++i) {
      if (i == 0 || (channels.size() < 6 && random.below(20) == 0)) {
        channels.push_back(channel_named("/t" + std::to_string(i), random.below(2) == 0 ? "a/msg/A" : "b/msg/B"));
        EXPECT_EQ(writer.add_channel(channels.back()), channels.size() - 1);
      }
      const auto channel = static_cast<std::uint16_t>(1 + random.below(std::ssize(channels) - 1));
      const std::int64_t time = kBegin + 100 * (i / 2) + random.below(disorder),
                         size = random.below(i == 100 ? 50000 : 200);
      written.push_back(write(writer, sequences, {channel, time, time - random.below(50), 0, random.bytes(size)}));
      if (random.below(30) == 0) writer.flush();
      if (random.below(60) == 0) writer.add_metadata("note " + std::to_string(i), {{"k", "v"}, {"", ""}});
    }
    writer.finish();
    writer.finish();
    EXPECT_EQ(writer.bytes(), static_cast<std::int64_t>(fs::file_size(file)));

    const Bytes bytes = bytes_in(file);
    for (const bool with_summary : {true, false}) {
      SCOPED_TRACE(with_summary);
      // Without the last byte the index is not used.
      McapReader reader(mcap::View(bytes).first(bytes.size() - (with_summary ? 0 : 1)), "a.mcap");
      EXPECT_EQ(reader.is_complete(), with_summary) << reader.damage();
      EXPECT_EQ(reader.message_count(), written.size());
      EXPECT_EQ(reader.begin_ns(), std::ranges::min(written, {}, &Logged::log_time).log_time);
      EXPECT_EQ(reader.end_ns(), std::ranges::max(written, {}, &Logged::log_time).log_time);
      EXPECT_EQ(rest_of(reader), by_time(written));
      EXPECT_FALSE(reader.next());
      EXPECT_EQ(reader.damaged_chunks() + reader.messages_without_channel(), 0u);
      for (const auto& [number, channel] : reader.channels()) EXPECT_EQ(channel, channels.at(number));
      EXPECT_LE(reader.channels().size(), channels.size() - 1) << "those without messages are in the index only";
      EXPECT_TRUE(!with_summary || reader.channels().size() == channels.size() - 1);
      for (const McapMetadata& note : reader.metadata()) EXPECT_EQ(note.pairs, (McapPairs{{"k", "v"}, {"", ""}}));
    }
  }
}

TEST(Mcap, SeekIsReadingEverythingAndLeavingOutWhatIsBefore) {
  const TestFolder folder;
  Random random(1);
  McapWriter writer(folder / "a.mcap", {.chunk_bytes = 500});
  writer.add_channel(channel_named("/a"));
  std::vector<std::uint32_t> sequences;
  std::vector<Logged> written;
  written.reserve(300);
  for (int i = 0; i < 300; ++i)
    written.push_back(
        write(writer, sequences, {1, kBegin + 10 * i + random.below(200), kBegin, 0, random.bytes(random.below(50))}));
  writer.finish();
  written = by_time(written);
  McapReader reader(folder / "a.mcap");
  for (int i = 0; i < 100; ++i) {
    const std::int64_t from = i == 0 ? -1 : kBegin - 50 + random.below(3400);
    SCOPED_TRACE(from);
    for (std::int64_t k = random.below(400); k-- > 0;) reader.next();
    reader.seek(from);
    std::vector<Logged> expected;
    std::ranges::copy_if(written, std::back_inserter(expected), [&](const Logged& m) { return m.log_time >= from; });
    EXPECT_EQ(rest_of(reader), expected);
  }
}

TEST(Mcap, FileCutAnywhereGivesAllWholeChunks) {
  const TestFolder folder;
  const SmallLog log = small_log(folder);
  ASSERT_GE(log.chunk_ends.size(), 3u);
  ASSERT_EQ(log.chunk_messages.back(), log.messages.size());
  for (std::size_t size = 0; size <= log.bytes.size(); ++size) {
    SCOPED_TRACE(size);
    const mcap::View cut = mcap::View(log.bytes).first(size);
    if (size < 8) {
      EXPECT_EQ(message_of([&] { McapReader reader(cut, "cut.mcap"); }),
                "cut.mcap: has " + std::to_string(size) + " bytes, too few for an MCAP file");
      continue;
    }
    McapReader reader(cut, "cut.mcap");
    std::size_t whole = 0;
    for (std::size_t i = 0; i < log.chunk_ends.size(); ++i)
      if (log.chunk_ends[i] <= size) whole = log.chunk_messages[i];
    const auto expected = std::vector(log.messages.begin(), log.messages.begin() + static_cast<std::ptrdiff_t>(whole));
    EXPECT_EQ(reader.message_count(), whole);
    EXPECT_EQ(rest_of(reader), expected);
    EXPECT_EQ(reader.is_complete(), size == log.bytes.size());
    EXPECT_EQ(reader.damage().empty(), reader.is_complete());
    EXPECT_EQ(reader.damaged_chunks() + reader.messages_without_channel(), 0u);
  }
  EXPECT_EQ(McapReader(mcap::View(log.bytes).first(log.chunk_ends[1] - 1), "cut.mcap").damage(),
            "ends at byte " + std::to_string(log.chunk_ends[1] - 1) + ", within the record that begins at byte " +
                std::to_string(log.chunk_begins[1]));
}

/// A record of a kind that is not in the format.
void append_unknown(Bytes& out, std::size_t size) {
  const std::size_t at = out.size();
  append(out, mcap::DataEnd{});
  out[at] = std::byte{0x85};
  out[at + 1] = static_cast<std::byte>(size);
  out.resize(at + mcap::kRecordHead + size);
}

/// A chunk with nothing in it.
Bytes compressed_chunk(const std::string& compression) {
  Bytes plain(mcap::kRecordHead + mcap::kChunkHead);
  mcap::put_chunk_head(plain, {});
  const std::size_t at = mcap::kRecordHead + 28;  // of the name's length
  plain[1] = static_cast<std::byte>(mcap::kChunkHead + compression.size());
  plain[at] = static_cast<std::byte>(compression.size());
  const mcap::View name = mcap::bytes_of(compression);
  plain.insert(plain.begin() + at + 4, name.begin(), name.end());
  return plain;
}

/// A file as other programs may write it: messages outside of chunks, records that nobody knows, no index.
Bytes loose_log(const std::vector<Logged>& messages) {
  Bytes out(mcap::kMagic.begin(), mcap::kMagic.end());
  append(out, mcap::Header{"", "another"});
  append(out, mcap::Schema{7, "a/msg/A", "ros2msg", "bool a"});
  append(out, mcap::Schema{8, "b/msg/B", "jsonschema", "{}"});
  append(out, mcap::Channel{1, 7, "/a", "cdr", {{"k", "v"}}});
  append(out, mcap::Channel{2, 8, "/b", "json", {}});
  append(out, mcap::Channel{3, 0, "/c", "", {}});
  for (const Logged& message : messages) {
    append(out, mcap::Message{message.channel, message.sequence, static_cast<std::uint64_t>(message.log_time),
                              static_cast<std::uint64_t>(message.publish_time), message.data});
    if (message.sequence % 3 == 1) append_unknown(out, message.sequence);
  }
  append(out, mcap::DataEnd{mcap::crc_of(out)});
  append(out, mcap::Footer{});
  out.insert(out.end(), mcap::kMagic.begin(), mcap::kMagic.end());
  return out;
}

std::vector<Logged> loose_messages(std::uint32_t count) {
  std::vector<Logged> messages;
  Random random(2);
  for (std::uint32_t i = 0; i < count; ++i)
    messages.push_back({static_cast<std::uint16_t>(1 + i % 3), kBegin + 100 * i - random.below(500), kBegin, i,
                        random.bytes(random.below(20))});
  return messages;
}

// Of what was damaged nothing is taken for what was written: it is left out, and the reader says so.
TEST(Mcap, ChangedByteIsNoticedOrHarmless) {
  const TestFolder folder;
  const SmallLog log = small_log(folder);
  const std::vector<Logged> loose = loose_messages(8);
  const mcap::View with_index = log.bytes, without_index = with_index.first(log.chunk_ends.back());
  const Bytes without_chunks = loose_log(loose);
  for (const mcap::View& file : {with_index, without_index, mcap::View(without_chunks)}) {
    const bool is_loose = file.data() == without_chunks.data();
    const std::vector<Logged> expected = by_time(is_loose ? loose : log.messages);
    const auto channels = McapReader(file, "whole.mcap").channels();
    int complete = 0, refused = 0;
    for (std::size_t at = 0; at < file.size(); ++at)
      for (const int change : {1, 2, 0x10, 0x80, 0xff}) {
        SCOPED_TRACE(testing::Message() << file.size() << " bytes, " << change << " at " << at);
        Bytes changed(file.begin(), file.end());
        changed[at] ^= static_cast<std::byte>(change);
        try {
          McapReader reader(changed, "changed.mcap");
          const std::vector<Logged> read = rest_of(reader);
          // Without checksums only that of the whole file tells.
          if (is_loose && !reader.is_complete()) continue;
          EXPECT_TRUE(std::ranges::includes(expected, read, {}, &Logged::log_time, &Logged::log_time));
          for (const Logged& message : read) EXPECT_THAT(expected, testing::Contains(message));
          for (const auto& [number, channel] : reader.channels()) EXPECT_EQ(channel, channels.at(number));
          if (!reader.is_complete() || reader.damaged_chunks() + reader.messages_without_channel() > 0) continue;
          EXPECT_EQ(read, expected);
          ++complete;
          for (std::size_t i = 0; !is_loose && i < log.chunk_ends.size(); ++i)
            EXPECT_TRUE(at < log.chunk_begins[i] + mcap::kRecordHead + mcap::kChunkHead || at >= log.chunk_ends[i]);
        } catch (const Error& error) {
          EXPECT_THAT(error.what(), testing::StartsWith("changed.mcap: "));
          ++refused;
        }
      }
    EXPECT_LE(refused, 5 * 8) << "the magic, nothing else";
    // The kind of the data's end, and what a footer says of an index that there is not.
    EXPECT_LE(complete, is_loose ? 5 * (1 + 12) : std::ssize(file) * 5);
  }
}

TEST(Mcap, DamagedChunkIsLeftOutAndCounted) {
  const TestFolder folder;
  SmallLog log = small_log(folder);
  log.bytes[log.chunk_ends[1] - 1] ^= std::byte{1};
  std::vector<Logged> expected = log.messages;
  expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(log.chunk_messages[0]),
                 expected.begin() + static_cast<std::ptrdiff_t>(log.chunk_messages[1]));
  for (const std::size_t size : {log.bytes.size(), log.chunk_ends.back()}) {
    McapReader reader(mcap::View(log.bytes).first(size), "a.mcap");
    for (int round = 0; round < 2; ++round) {
      EXPECT_EQ(rest_of(reader), expected);
      EXPECT_EQ(reader.damaged_chunks(), 1u);
      reader.seek(0);
    }
  }
}

TEST(Mcap, ReadsWhatOthersWrite) {
  const std::vector<Logged> messages = loose_messages(50);
  Bytes file = loose_log(messages);
  McapReader reader(file, "a.mcap");
  EXPECT_TRUE(reader.is_complete()) << reader.damage();
  EXPECT_EQ(reader.message_count(), messages.size());
  EXPECT_EQ(rest_of(reader), by_time(messages));
  const McapChannel a{"/a", "a/msg/A", "bool a", {{"k", "v"}}}, b{"/b", "b/msg/B", "{}", {}, "jsonschema", "json"},
      c{"/c", "", "", {}, "", ""};
  EXPECT_THAT(reader.channels(), testing::ElementsAre(testing::Pair(1, a), testing::Pair(2, b), testing::Pair(3, c)));

  // Chunks without checksum and index, with records that nobody knows; a channel that is nowhere described.
  Bytes chunked(mcap::kMagic.begin(), mcap::kMagic.end()), chunk(mcap::kRecordHead + mcap::kChunkHead);
  append(chunked, mcap::Header{"", "another"});
  append_unknown(chunk, 1);
  append(chunk, mcap::Channel{5, 0, "/e", "cdr", {}});
  for (const std::uint16_t channel : {5, 6, 5}) append(chunk, mcap::Message{channel, 0, 7, 8, mcap::bytes_of("data")});
  append_unknown(chunk, 2);
  mcap::put_chunk_head(chunk, {});
  const std::size_t chunk_at = chunked.size();
  chunked.insert(chunked.end(), chunk.begin(), chunk.end());
  const Bytes data = chunked;
  append(chunked, mcap::Footer{});
  chunked.insert(chunked.end(), mcap::kMagic.begin(), mcap::kMagic.end());
  McapReader other(chunked, "b.mcap");
  EXPECT_TRUE(other.is_complete()) << other.damage();
  EXPECT_EQ(rest_of(other).size(), 2u);
  EXPECT_EQ(other.messages_without_channel(), 1u);

  // An index with times that are none is no reason to find less, nor one that lists a chunk twice.
  const mcap::ChunkIndex index{.begin = ~std::uint64_t{0}, .chunk_start = chunk_at, .chunk_length = chunk.size()};
  for (const std::uint32_t listed : {1, 2}) {
    Bytes file_with = data;
    append(file_with, mcap::DataEnd{});
    const mcap::Footer footer{.summary_start = file_with.size()};
    for (std::uint32_t i = 0; i < listed; ++i) append(file_with, index);
    append(file_with, mcap::Statistics{.message_count = 3, .chunk_count = listed});
    append(file_with, footer);
    file_with.insert(file_with.end(), mcap::kMagic.begin(), mcap::kMagic.end());
    McapReader strange(file_with, "d.mcap");
    EXPECT_EQ(strange.damage(), listed == 1 ? "" : "has a damaged index");
    EXPECT_EQ(rest_of(strange).size(), 2u);
    EXPECT_EQ(strange.end_ns(), 7);
  }

  // The smallest file there is.
  Bytes empty(mcap::kMagic.begin(), mcap::kMagic.end());
  append(empty, mcap::Header{});
  append(empty, mcap::Footer{});
  empty.insert(empty.end(), mcap::kMagic.begin(), mcap::kMagic.end());
  McapReader none(empty, "c.mcap");
  EXPECT_TRUE(none.is_complete()) << none.damage();
  EXPECT_FALSE(none.next());
}

TEST(Mcap, ReaderSaysWhatItCannotRead) {
  const TestFolder folder;
  const std::string path = (folder / "a.mcap").string();
  const auto refused = [&] { return message_of([&] { McapReader reader(path); }); };
  EXPECT_EQ(refused(), path + ": cannot be opened: No such file or directory");
  EXPECT_EQ(message_of([&] { McapReader reader(folder.path()); }),
            folder.path().string() + ": is no file, must be one of MCAP");
  std::ofstream(path) << "{\"frame\":0}";
  EXPECT_EQ(refused(), path + ": is no MCAP file, must begin with the bytes 89 4d 43 41 50");
  std::ofstream(path) << "\x89MCAP1\r\n";
  EXPECT_EQ(refused(), path + ": is of another version of MCAP, must be of version 0");

  for (const std::string compression : {"lz4", "zstd"}) {
    Bytes file(mcap::kMagic.begin(), mcap::kMagic.end());
    const Bytes chunk = compressed_chunk(compression);
    file.insert(file.end(), chunk.begin(), chunk.end());
    EXPECT_EQ(message_of([&] { McapReader reader(file, "a.mcap"); }),
              "a.mcap: chunk at byte 8 is compressed by " + compression +
                  ", must not be compressed; `mcap compress --compression none` makes such a file");
  }

  // A hole in a file takes no disk.
  Bytes large(mcap::kMagic.begin(), mcap::kMagic.end());
  large.push_back(static_cast<std::byte>(mcap::Opcode::message));
  for (const int byte : {0, 0, 0, 0x11, 0, 0, 0, 0}) large.push_back(static_cast<std::byte>(byte));
  std::ofstream(path).write(reinterpret_cast<const char*>(large.data()), std::ssize(large));
  fs::resize_file(path, 300 << 20);
  EXPECT_EQ(refused(), path + ": record at byte 8 has 285212681 bytes, must be at most 268435456");
  // What need not be in memory may be large.
  large[8] = static_cast<std::byte>(mcap::Opcode::attachment);
  std::ofstream(path).write(reinterpret_cast<const char*>(large.data()), std::ssize(large));
  fs::resize_file(path, 8 + 285212681);
  EXPECT_EQ(McapReader(path).damage(), "ends at byte 285212689, after a whole record: it was not finished");
}

TEST(Mcap, WriterSaysWhatItCannotWrite) {
  const TestFolder folder;
  const std::string path = (folder / "a.mcap").string();
  EXPECT_EQ(message_of([&] { McapWriter writer(path, {.chunk_bytes = 0}); }),
            "mcap.chunk_bytes: is 0, must be >= 1 and <= 67108864");
  EXPECT_EQ(message_of([&] { McapWriter writer(path, {.chunk_seconds = -1}); }),
            "mcap.chunk_seconds: is -1.000000, must be >= 0 and <= 3600");
  EXPECT_FALSE(fs::exists(path));
  EXPECT_EQ(message_of([&] { McapWriter writer(folder / "no/a.mcap"); }),
            (folder / "no/a.mcap").string() + ": cannot be opened for writing: No such file or directory");
  McapWriter writer(path);
  EXPECT_EQ(message_of([&] { McapWriter second(path); }), path + ": is there already, must be the name of a new file");
  const std::uint16_t channel = writer.add_channel(channel_named("/a"));
  EXPECT_EQ(message_of([&] { writer.write(channel, -1, 0, {}); }),
            path + ": message on /a has the time -1 ns, must be >= 0");
  const std::string text(17 << 20, 'x');
  EXPECT_THAT(message_of([&] { writer.add_channel(channel_named(text)); }),
              HasSubstr("bytes, must be at most 16776192"));
  EXPECT_THAT(message_of([&] {
                writer.add_metadata("a", {{"k", text}});
              }),
              HasSubstr("a.mcap: metadata a has texts of"));
  writer.write(channel, 1, 1, {});
  writer.finish();
  McapReader reader(path);
  EXPECT_EQ(rest_of(reader).size(), 1u) << "what was refused leaves no trace";
}

TEST(Mcap, EqualSchemasAreWrittenOnce) {
  const TestFolder folder;
  McapWriter writer(folder / "a.mcap", {.chunk_bytes = 1});
  McapChannel other = channel_named("/other");
  other.definition += "\nbool changed";
  const McapChannel bare{.topic = "/bare", .schema_encoding = "", .message_encoding = "json"};
  const std::vector<McapChannel> channels{channel_named("/a"), channel_named("/b"), channel_named("/a"), other, bare};
  for (int round = 0; round < 3; ++round)
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const auto number = static_cast<std::uint16_t>(i + 1);
      EXPECT_TRUE(round > 0 || writer.add_channel(channels[i]) == number);
      writer.write(number, kBegin, kBegin, {});
    }
  writer.finish();
  const Bytes bytes = bytes_in(folder / "a.mcap");
  std::map<mcap::Opcode, int> in_chunks, in_summary;
  mcap::for_each_record(mcap::View(bytes).subspan(8, bytes.size() - 16), [&](mcap::Opcode opcode, mcap::View content,
                                                                             std::size_t) {
    ++in_summary[opcode];
    if (opcode != mcap::Opcode::chunk) return true;
    return mcap::for_each_record(mcap::parse_chunk(content)->records,
                                 [&](mcap::Opcode inner, mcap::View, std::size_t) { return ++in_chunks[inner] > 0; });
  });
  EXPECT_EQ(in_chunks[mcap::Opcode::schema], 2);
  EXPECT_EQ(in_chunks[mcap::Opcode::channel], 5);
  EXPECT_EQ(in_chunks[mcap::Opcode::message], 15);
  EXPECT_EQ(in_summary[mcap::Opcode::schema], 2);
  EXPECT_EQ(in_summary[mcap::Opcode::channel], 5);
  for (const std::size_t size : {bytes.size(), bytes.size() - 1}) {
    McapReader reader(mcap::View(bytes).first(size), "a.mcap");
    ASSERT_EQ(reader.channels().size(), channels.size());
    for (const auto& [number, channel] : reader.channels()) EXPECT_EQ(channel, channels[number - 1u]);
  }
}

TEST(Mcap, FileIsFinishedWithItsWriter) {
  const TestFolder folder;
  {
    McapWriter writer(folder / "a.mcap");
    const std::uint16_t channel = writer.add_channel(channel_named("/a"));
    McapWriter moved = std::move(writer);
    moved.write(channel, kBegin, kBegin, mcap::bytes_of("x"));
    EXPECT_EQ(McapReader(folder / "a.mcap").message_count(), 0u);
    moved.flush();
    EXPECT_EQ(McapReader(folder / "a.mcap").message_count(), 1u);
    moved.write(channel, kBegin, kBegin, mcap::bytes_of("y"));
  }
  McapReader reader(folder / "a.mcap");
  EXPECT_TRUE(reader.is_complete()) << reader.damage();
  EXPECT_EQ(rest_of(reader).size(), 2u);
}

// Whenever it happens: all is there but what came since the last chunk, less than chunk_seconds and chunk_bytes.
TEST(Mcap, KilledProcessLosesTheLastChunkAtMost) {
  const TestFolder folder;
  constexpr std::int64_t kStep = 40'000'000;
  constexpr std::size_t kSize = 100, kHead = mcap::kRecordHead + mcap::kMessageHead;
  for (const bool by_size : {true, false})
    for (int messages = 0; messages < 25; ++messages) {
      SCOPED_TRACE(testing::Message() << messages << (by_size ? " by size" : " by time"));
      const fs::path file = folder / (std::to_string(messages) + (by_size ? "s" : "t"));
      const McapOptions options = by_size ? McapOptions{.chunk_bytes = 1000} : McapOptions{.chunk_seconds = .2};
      const pid_t child = ::fork();
      ASSERT_GE(child, 0);
      if (child == 0) {
        McapWriter writer(file, options);
        const std::uint16_t channel = writer.add_channel(channel_named("/a"));
        const Bytes data(kSize, std::byte{7});
        for (int i = 0; i < messages; ++i) writer.write(channel, kBegin + kStep * i, kBegin, data);
        ::kill(::getpid(), SIGKILL);
      }
      int status = 0;
      ASSERT_EQ(::waitpid(child, &status, 0), child);
      ASSERT_TRUE(WIFSIGNALED(status));
      McapReader reader(file);
      EXPECT_FALSE(reader.is_complete());
      const std::vector<Logged> read = rest_of(reader);
      for (std::size_t i = 0; i < read.size(); ++i)
        EXPECT_EQ(read[i], (Logged{1, kBegin + kStep * static_cast<std::int64_t>(i), kBegin,
                                   static_cast<std::uint32_t>(i), Bytes(kSize, std::byte{7})}));
      const auto lost = messages - std::ssize(read);
      if (by_size) {
        EXPECT_LT(lost * static_cast<std::ptrdiff_t>(kSize + kHead), 1000);
      } else {
        EXPECT_LE(lost, 5);
      }
    }
}

/// While alive, files cannot grow beyond `size`: like a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t size) : handler_(::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{size, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    ::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  sighandler_t handler_;
  rlimit before_{};
};

TEST(Mcap, FullDiskLeavesWholeChunks) {
  const TestFolder folder;
  const std::string path = (folder / "a.mcap").string();
  McapWriter writer(path, {.chunk_bytes = 500});
  const std::uint16_t channel = writer.add_channel(channel_named("/a"));
  const Bytes data(120);
  int written = 0;
  {
    const FileSizeLimit full(3000);
    const auto fill = [&] {
      for (; written < 100; ++written) writer.write(channel, kBegin + written, kBegin, data);
    };
    EXPECT_EQ(message_of(fill), path + ": cannot be written: File too large");
    EXPECT_LT(written, 20);
    EXPECT_EQ(message_of(fill), path + ": cannot be written: File too large") << "and so it stays";
    EXPECT_EQ(message_of([&] { writer.flush(); }), path + ": cannot be written: File too large");
    EXPECT_EQ(message_of([&] { writer.add_metadata("a", {}); }), path + ": cannot be written: File too large");
    EXPECT_EQ(message_of([&] { writer.finish(); }), path + ": cannot be written: File too large");
  }
  McapReader cut(path);
  EXPECT_EQ(cut.damage(),
            "ends at byte " + std::to_string(fs::file_size(path)) + ", after a whole record: it was not finished");
  const std::vector<Logged> read = rest_of(cut);
  EXPECT_GT(read.size(), 5u);
  EXPECT_GT(read.size() + 5, static_cast<std::size_t>(written));
  // With room again the index of what is there can be written.
  writer.finish();
  McapReader finished(path);
  EXPECT_TRUE(finished.is_complete()) << finished.damage();
  EXPECT_EQ(rest_of(finished), read);
  EXPECT_EQ(finished.message_count(), read.size());
}

}  // namespace
}  // namespace tassilo
