#include "tassilo/record/mcap_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/record/internal/mcap_format.h"

namespace tassilo {
namespace {

constexpr std::size_t kMaxChunk = std::size_t{64} << 20;
constexpr std::size_t kMaxMessage = std::size_t{128} << 20;
// The largest chunk there can be: complete but for a byte, then one more channel with its schema and a message.
static_assert(kMaxChunk + kMaxMessage + 2 * mcap::kMaxDescription + 1024 < mcap::kMaxRecord);

/// Times of messages and how many they are.
struct Extent {
  std::uint64_t count = 0, begin = 0, end = 0;  ///< All 0 without messages.

  void add(const Extent& other) {
    if (other.count == 0) return;
    begin = count == 0 ? other.begin : std::min(begin, other.begin);
    end = std::max(end, other.end);
    count += other.count;
  }
};

std::size_t text_size(const McapPairs& pairs) {
  std::size_t size = 0;
  for (const auto& [key, value] : pairs) size += key.size() + value.size() + 8;
  return size;
}

}  // namespace

void McapOptions::check() const {
  if (chunk_bytes < 1 || chunk_bytes > kMaxChunk)
    throw Error("mcap.chunk_bytes",
                "is " + std::to_string(chunk_bytes) + ", must be >= 1 and <= " + std::to_string(kMaxChunk));
  if (!(chunk_seconds >= 0 && chunk_seconds <= 3600))
    throw Error("mcap.chunk_seconds", "is " + std::to_string(chunk_seconds) + ", must be >= 0 and <= 3600");
}

/// The file, what is in it, and the chunk at work.
class McapWriter::File {
 public:
  File(const std::filesystem::path& file, const McapOptions& options)
      : name_(file.string()),
        chunk_bytes_(options.chunk_bytes),
        chunk_ns_(static_cast<std::uint64_t>(std::llround(options.chunk_seconds * 1e9))) {
    options.check();
    fd_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd_ < 0 && errno == EEXIST) throw Error(name_, "is there already, must be the name of a new file");
    if (fd_ < 0) throw Error(name_, std::string("cannot be opened for writing: ") + std::strerror(errno));
    mcap::Bytes out(mcap::kMagic.begin(), mcap::kMagic.end());
    append(out, mcap::Header{"ros2", "tassilo " TASSILO_VERSION});
    try {
      put(out);
    } catch (const Error&) {
      close();
      ::unlink(name_.c_str());
      throw;
    }
    begin_chunk();
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    // Once for all that is left, and once more for the index of what is there.
    for (int attempt = 0; attempt < 2 && fd_ >= 0; ++attempt) try {
        finish();
      } catch (...) {
      }
    close();
  }

  std::uint16_t add_channel(const McapChannel& channel) {
    const std::size_t texts = channel.topic.size() + channel.schema_name.size() + channel.definition.size() +
                              channel.schema_encoding.size() + channel.message_encoding.size() +
                              text_size(channel.metadata);
    check_description(texts, "channel " + channel.topic);
    if (channels_.size() == std::numeric_limits<std::uint16_t>::max())
      throw Error(name_, "has 65535 channels, which is all there can be");
    ChannelState& added = channels_.emplace_back();
    added.channel = channel;
    if (!channel.schema_name.empty()) added.schema = schema_of(channel);
    return static_cast<std::uint16_t>(channels_.size());
  }

  void write(std::uint16_t number, std::int64_t log_time_ns, std::int64_t publish_time_ns, mcap::View message) {
    expects(fd_ >= 0, "McapWriter: nothing is written after finish");
    expects(number >= 1 && number <= channels_.size(), "McapWriter: a channel is added before it is written");
    refuse_if_failed();
    ChannelState& channel = channels_[number - 1];
    for (const std::int64_t time : {log_time_ns, publish_time_ns})
      if (time < 0)
        throw Error(name_, "message on " + channel.channel.topic + " has the time " + std::to_string(time) +
                               " ns, must be >= 0");
    if (message.size() > kMaxMessage)
      throw Error(name_, "message on " + channel.channel.topic + " has " + std::to_string(message.size()) +
                             " bytes, must be at most " + std::to_string(kMaxMessage));
    describe(number);
    const auto log_time = static_cast<std::uint64_t>(log_time_ns);
    channel.in_chunk.emplace_back(log_time, chunk_.size() - kChunkBegin);
    append(chunk_,
           mcap::Message{number, channel.sequence++, log_time, static_cast<std::uint64_t>(publish_time_ns), message});
    chunk_extent_.add({1, log_time, log_time});
    if (chunk_.size() - kChunkBegin >= chunk_bytes_ || chunk_extent_.end - chunk_extent_.begin >= chunk_ns_) flush();
  }

  void flush() {
    expects(fd_ >= 0, "McapWriter: nothing is flushed after finish");
    refuse_if_failed();
    if (chunk_extent_.count == 0) return;
    const mcap::View records = mcap::View(chunk_).subspan(kChunkBegin);
    mcap::ChunkIndex index{.begin = chunk_extent_.begin,
                           .end = chunk_extent_.end,
                           .chunk_start = size_,
                           .chunk_length = chunk_.size(),
                           .compressed_size = records.size(),
                           .uncompressed_size = records.size()};
    mcap::Chunk head{.begin = index.begin, .end = index.end, .uncompressed_crc = mcap::crc_of(records)};
    put_chunk_head(chunk_, head);
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      if (channels_[i].in_chunk.empty()) continue;
      const auto number = static_cast<std::uint16_t>(i + 1);
      index.message_index_offsets.emplace_back(number, size_ + chunk_.size());
      append(chunk_, mcap::MessageIndex{number, channels_[i].in_chunk});
    }
    index.message_index_length = chunk_.size() - index.chunk_length;
    try {
      put(chunk_);
    } catch (const Error& error) {
      failure_ = error;
      throw;
    }
    extent_.add(chunk_extent_);
    for (ChannelState& channel : channels_) channel.count += channel.in_chunk.size();
    chunks_.push_back(std::move(index));
    begin_chunk();
  }

  void add_metadata(const McapMetadata& metadata) {
    expects(fd_ >= 0, "McapWriter: nothing is written after finish");
    refuse_if_failed();
    check_description(metadata.name.size() + text_size(metadata.pairs), "metadata " + metadata.name);
    mcap::Bytes out;
    append(out, mcap::Metadata{metadata.name, metadata.pairs});
    const std::uint64_t at = size_;
    put(out);
    notes_.push_back({at, out.size(), metadata.name});
  }

  void finish() {
    if (fd_ < 0) return;
    if (!failure_) flush();
    put(end_of_file());
    const int closed = close();
    if (closed != 0) throw Error(name_, std::string("cannot be written: ") + std::strerror(errno));
  }

  std::int64_t bytes() const {
    return static_cast<std::int64_t>(size_ + (chunk_extent_.count == 0 ? 0 : chunk_.size()));
  }

 private:
  static constexpr std::size_t kChunkBegin = mcap::kRecordHead + mcap::kChunkHead;

  struct ChannelState {
    McapChannel channel;
    std::optional<std::size_t> schema;
    bool is_described = false;
    std::uint32_t sequence = 0;
    std::uint64_t count = 0;                                          ///< In the file.
    std::vector<std::pair<std::uint64_t, std::uint64_t>> in_chunk{};  ///< Log time and place of each message.
  };
  struct SchemaState {
    std::string name, encoding, definition;
    bool is_described = false;
  };
  struct Note {
    std::uint64_t at = 0, length = 0;
    std::string name;
  };

  void check_description(std::size_t texts, const std::string& what) const {
    constexpr std::size_t kMax = mcap::kMaxDescription - 1024;
    if (texts > kMax)
      throw Error(name_,
                  what + " has texts of " + std::to_string(texts) + " bytes, must be at most " + std::to_string(kMax));
  }

  std::size_t schema_of(const McapChannel& channel) {
    const auto is_same = [&](const SchemaState& schema) {
      return schema.name == channel.schema_name && schema.encoding == channel.schema_encoding &&
             schema.definition == channel.definition;
    };
    const auto found = std::find_if(schemas_.begin(), schemas_.end(), is_same);
    if (found != schemas_.end()) return static_cast<std::size_t>(found - schemas_.begin());
    schemas_.push_back({channel.schema_name, channel.schema_encoding, channel.definition});
    return schemas_.size() - 1;
  }

  /// Puts the channel and its schema into the chunk unless an earlier one has them.
  void describe(std::uint16_t number) {
    ChannelState& channel = channels_[number - 1];
    if (channel.is_described) return;
    if (channel.schema && !schemas_[*channel.schema].is_described) {
      append_schema(chunk_, *channel.schema);
      schemas_[*channel.schema].is_described = true;
    }
    append_channel(chunk_, number);
    channel.is_described = true;
  }

  void append_schema(mcap::Bytes& out, std::size_t index) const {
    const SchemaState& schema = schemas_[index];
    append(out, mcap::Schema{static_cast<std::uint16_t>(index + 1), schema.name, schema.encoding, schema.definition});
  }

  void append_channel(mcap::Bytes& out, std::uint16_t number) const {
    const ChannelState& state = channels_[number - 1];
    const auto schema = static_cast<std::uint16_t>(state.schema ? *state.schema + 1 : 0);
    append(out,
           mcap::Channel{number, schema, state.channel.topic, state.channel.message_encoding, state.channel.metadata});
  }

  void begin_chunk() {
    chunk_.resize(kChunkBegin);
    chunk_extent_ = {};
    for (ChannelState& channel : channels_) channel.in_chunk.clear();
  }

  mcap::Bytes end_of_file() const {
    mcap::Bytes out;
    append(out, mcap::DataEnd{crc_});
    const std::size_t summary = out.size();

    std::vector<mcap::SummaryOffset> groups;
    const auto group = [&](mcap::Opcode opcode, const auto& fill) {
      const std::size_t at = out.size();
      fill();
      if (out.size() > at) groups.push_back({opcode, size_ + at, out.size() - at});
    };
    group(mcap::Opcode::schema, [&] {
      for (std::size_t i = 0; i < schemas_.size(); ++i) append_schema(out, i);
    });
    group(mcap::Opcode::channel, [&] {
      for (std::size_t i = 0; i < channels_.size(); ++i) append_channel(out, static_cast<std::uint16_t>(i + 1));
    });
    group(mcap::Opcode::statistics, [&] { append(out, statistics()); });
    group(mcap::Opcode::chunk_index, [&] {
      for (const mcap::ChunkIndex& chunk : chunks_) append(out, chunk);
    });
    group(mcap::Opcode::metadata_index, [&] {
      for (const Note& note : notes_) append(out, mcap::MetadataIndex{note.at, note.length, note.name});
    });

    mcap::Footer footer{.summary_start = size_ + summary, .summary_offset_start = size_ + out.size()};
    for (const mcap::SummaryOffset& offset : groups) append(out, offset);
    const std::size_t at = out.size();
    append(out, footer);
    footer.summary_crc = mcap::crc_of(mcap::View(out).subspan(summary, out.size() - summary - 4));
    out.resize(at);
    append(out, footer);
    out.insert(out.end(), mcap::kMagic.begin(), mcap::kMagic.end());
    return out;
  }

  mcap::Statistics statistics() const {
    mcap::Statistics all{.message_count = extent_.count,
                         .schema_count = static_cast<std::uint16_t>(schemas_.size()),
                         .channel_count = static_cast<std::uint32_t>(channels_.size()),
                         .metadata_count = static_cast<std::uint32_t>(notes_.size()),
                         .chunk_count = static_cast<std::uint32_t>(chunks_.size()),
                         .begin = extent_.begin,
                         .end = extent_.end};
    for (std::size_t i = 0; i < channels_.size(); ++i)
      all.channel_message_counts.emplace_back(static_cast<std::uint16_t>(i + 1), channels_[i].count);
    return all;
  }

  /// Appends to the file in one write. Throws Error when not all of it goes in; the file is then as it was.
  void put(mcap::View bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t written = ::pwrite(fd_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(size_ + done));
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) {
        std::string reason = std::string("cannot be written: ") + std::strerror(written < 0 ? errno : ENOSPC);
        if (done > 0 && ::ftruncate(fd_, static_cast<off_t>(size_)) != 0) reason += "; its last record is incomplete";
        throw Error(name_, reason);
      }
      done += static_cast<std::size_t>(written);
    }
    size_ += bytes.size();
    crc_ = mcap::crc_of(bytes, crc_);
  }

  void refuse_if_failed() const {
    if (failure_) throw *failure_;
  }

  int close() {
    const int closed = fd_ < 0 ? 0 : ::close(fd_);
    fd_ = -1;
    return closed;
  }

  std::string name_;
  std::size_t chunk_bytes_;
  std::uint64_t chunk_ns_;
  int fd_ = -1;
  std::uint64_t size_ = 0;  ///< Of the file; the chunk at work is not in it.
  std::uint32_t crc_ = 0;   ///< Of all of the file.
  std::optional<Error> failure_;
  std::vector<SchemaState> schemas_;    ///< By number, from 1.
  std::vector<ChannelState> channels_;  ///< By number, from 1.
  std::vector<mcap::ChunkIndex> chunks_;
  std::vector<Note> notes_;
  Extent extent_;
  mcap::Bytes chunk_;  ///< Place for the head, then the records.
  Extent chunk_extent_;
};

McapWriter::McapWriter(const std::filesystem::path& file, const McapOptions& options)
    : file_(std::make_unique<File>(file, options)) {}
McapWriter::McapWriter(McapWriter&&) noexcept = default;
McapWriter& McapWriter::operator=(McapWriter&&) noexcept = default;
McapWriter::~McapWriter() = default;

std::uint16_t McapWriter::add_channel(const McapChannel& channel) { return file_->add_channel(channel); }

void McapWriter::write(std::uint16_t channel, std::int64_t log_time_ns, std::int64_t publish_time_ns,
                       std::span<const std::byte> message) {
  file_->write(channel, log_time_ns, publish_time_ns, message);
}

void McapWriter::flush() { file_->flush(); }

void McapWriter::add_metadata(const std::string& name, const McapPairs& pairs) { file_->add_metadata({name, pairs}); }

void McapWriter::finish() { file_->finish(); }

std::int64_t McapWriter::bytes() const { return file_->bytes(); }

}  // namespace tassilo
