#include "tassilo/record/mcap_reader.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "tassilo/base/error.h"
#include "tassilo/record/internal/mcap_format.h"

namespace tassilo {
namespace {

using mcap::kMaxRecord;
using mcap::kRecordHead;

constexpr std::uint64_t kMaxDescriptions = std::uint64_t{64} << 20;  ///< All channels, all schemas. [bytes]
constexpr std::size_t kWindow = std::size_t{64} << 10;               ///< Read at once for small things. [bytes]
constexpr std::uint64_t kRun = std::uint64_t{1} << 20;  ///< Messages outside of chunks are read by so much. [bytes]

/// The bytes of a file, wherever they are.
class Source {
 public:
  Source(std::string name, std::uint64_t size) : name_(std::move(name)), size_(size) {}
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;

  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }
  /// Fills `bytes` from there on, all of it within the size. Throws Error when they cannot be read.
  virtual void read(std::uint64_t at, std::span<std::byte> bytes) const = 0;

 private:
  std::string name_;
  std::uint64_t size_;
};

class MemorySource final : public Source {
 public:
  MemorySource(mcap::View bytes, const std::string& name) : Source(name, bytes.size()), bytes_(bytes) {}

  void read(std::uint64_t at, std::span<std::byte> bytes) const override {
    std::ranges::copy(bytes_.subspan(static_cast<std::size_t>(at), bytes.size()), bytes.begin());
  }

 private:
  mcap::View bytes_;
};

class Descriptor {
 public:
  explicit Descriptor(const std::string& file) : fd_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (fd_ < 0) throw Error(file, std::string("cannot be opened: ") + std::strerror(errno));
  }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }
  std::uint64_t size(const std::string& file) const {
    struct stat status {};
    if (::fstat(fd_, &status) != 0) throw Error(file, std::string("cannot be read: ") + std::strerror(errno));
    if (!S_ISREG(status.st_mode)) throw Error(file, "is no file, must be one of MCAP");
    return static_cast<std::uint64_t>(status.st_size);
  }

 private:
  int fd_;
};

class FileSource final : public Source {
 public:
  explicit FileSource(const std::string& file) : FileSource(file, Descriptor(file)) {}

  void read(std::uint64_t at, std::span<std::byte> bytes) const override {
    while (!bytes.empty()) {
      const ssize_t got = ::pread(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(at));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw Error(name(), std::string("cannot be read: ") + std::strerror(errno));
      if (got == 0)
        throw Error(name(), "ends at byte " + std::to_string(at) + ": it became shorter since it was opened");
      at += static_cast<std::uint64_t>(got);
      bytes = bytes.subspan(static_cast<std::size_t>(got));
    }
  }

 private:
  FileSource(const std::string& file, Descriptor descriptor)
      : Source(file, descriptor.size(file)), file_(std::move(descriptor)) {}

  Descriptor file_;
};

/// What is read together: a chunk, or neighboring records outside of chunks.
struct Block {
  std::uint64_t at = 0, size = 0;    ///< With the head of a chunk's record.
  std::uint64_t begin = 0, end = 0;  ///< Log times of its messages. [ns]
  std::uint64_t count = 0;           ///< Messages, where they were counted.
  bool is_chunk = false;
  bool is_damaged = false;

  void add(std::uint64_t time) {
    begin = count == 0 ? time : std::min(begin, time);
    end = count == 0 ? time : std::max(end, time);
    ++count;
  }
};

/// Where a message is.
struct Entry {
  std::uint64_t time = 0, at = 0;  ///< at: of its content in the file.
  std::uint32_t size = 0;
};

/// For a heap with the first message on top.
constexpr auto kLater = [](const Entry& a, const Entry& b) {
  return std::pair(a.time, a.at) > std::pair(b.time, b.at);
};

bool is_time(std::uint64_t time) { return time <= std::uint64_t{std::numeric_limits<std::int64_t>::max()}; }

std::string at_byte(std::uint64_t at) { return " at byte " + std::to_string(at); }

}  // namespace

class McapReader::Log {
 public:
  explicit Log(std::unique_ptr<Source> source) : source_(std::move(source)) {
    check_magic();
    const Index index = read_summary();
    if (!index.is_usable) {
      blocks_.clear();
      notes_.clear();
      scan(index);
    }
    std::ranges::stable_sort(blocks_, {}, &Block::begin);
  }

  const std::map<std::uint16_t, McapChannel>& channels() const { return channels_; }
  std::uint64_t begin() const { return begin_; }
  std::uint64_t end() const { return end_; }
  std::uint64_t message_count() const { return message_count_; }
  const std::string& damage() const { return damage_; }
  std::uint64_t damaged_chunks() const { return damaged_chunks_; }
  std::uint64_t messages_without_channel() const { return messages_without_channel_; }

  std::vector<McapMetadata> metadata() const {
    std::vector<McapMetadata> all;
    std::uint64_t total = 0;
    mcap::Bytes record;
    for (const Block& note : notes_) {
      total += note.size;
      if (note.size > mcap::kMaxDescription || total > kMaxDescriptions)
        throw Error(source_->name(), "has too much metadata" + at_byte(note.at) + ", must be at most " +
                                         std::to_string(mcap::kMaxDescription) + " bytes each and " +
                                         std::to_string(kMaxDescriptions) + " in all");
      record.resize(static_cast<std::size_t>(note.size));
      source_->read(note.at, record);
      mcap::for_each_record(record, [&](mcap::Opcode opcode, mcap::View content, std::size_t) {
        if (opcode != mcap::Opcode::metadata) return false;
        if (auto read = mcap::parse_metadata(content)) all.push_back({std::string(read->name), std::move(read->pairs)});
        return true;
      });
    }
    return all;
  }

  void seek(std::uint64_t time) {
    from_ = time;
    next_block_ = 0;
    waiting_.clear();
  }

  std::optional<McapMessage> next() {
    for (;;) {
      while (next_block_ < blocks_.size() && (waiting_.empty() || blocks_[next_block_].begin <= waiting_.front().time))
        load(blocks_[next_block_++]);
      if (waiting_.empty()) return std::nullopt;
      std::ranges::pop_heap(waiting_, kLater);
      const Entry entry = waiting_.back();
      waiting_.pop_back();
      const auto message = mcap::parse_message(content_of(entry));
      // It was when its chunk was loaded; the file may have been changed since.
      if (!message || message->log_time != entry.time)
        throw Error(source_->name(), "has another message" + at_byte(entry.at) + " than when it was opened");
      if (channels_.count(message->channel) == 0) {
        ++messages_without_channel_;
        continue;
      }
      return McapMessage{message->channel, static_cast<std::int64_t>(message->log_time),
                         static_cast<std::int64_t>(message->publish_time), message->sequence, message->data};
    }
  }

 private:
  struct Index {
    bool is_usable = false;
    std::string damage{};        ///< Empty also where there is none.
    std::uint64_t data_end = 0;  ///< Where the data must end; 0: not known.
  };

  void check_magic() const {
    std::array<std::byte, mcap::kMagic.size()> begin{};
    if (source_->size() < begin.size())
      throw Error(source_->name(), "has " + std::to_string(source_->size()) + " bytes, too few for an MCAP file");
    source_->read(0, begin);
    if (begin == mcap::kMagic) return;
    const bool is_mcap = std::equal(begin.begin(), begin.begin() + 5, mcap::kMagic.begin());
    throw Error(source_->name(), is_mcap ? "is of another version of MCAP, must be of version 0"
                                         : "is no MCAP file, must begin with the bytes 89 4d 43 41 50");
  }

  // ---- with an index

  Index read_summary() {
    constexpr std::uint64_t kTail = kRecordHead + mcap::kFooter + mcap::kMagic.size();
    const std::uint64_t size = source_->size();
    if (size < mcap::kMagic.size() + kTail) return {false, "ends before its index"};
    const std::uint64_t footer_at = size - kTail;
    const mcap::Bytes tail = read(footer_at, kTail);
    if (!std::ranges::equal(mcap::View(tail).last(mcap::kMagic.size()), mcap::kMagic))
      return {false, "ends at byte " + std::to_string(size) + ", before the end of its index"};
    const mcap::RecordHead head = mcap::parse_head(mcap::View(tail).first<kRecordHead>());
    if (head.opcode != mcap::Opcode::footer || head.length != mcap::kFooter) return {false, "has a damaged footer"};
    const auto footer = mcap::parse_footer(mcap::View(tail).subspan(kRecordHead, mcap::kFooter));
    if (footer->summary_start == 0) return {.data_end = footer_at};
    if (footer->summary_start < mcap::kMagic.size() || footer->summary_start > footer_at)
      return {false, "has a damaged footer"};
    const std::uint64_t summary_size = footer_at - footer->summary_start;
    Index index{.data_end = footer->summary_start};
    if (summary_size > kMaxRecord) return index;  // without it all can be found, too
    const mcap::Bytes summary = read(footer->summary_start, summary_size);
    const std::uint32_t crc =
        mcap::crc_of(mcap::View(tail).first(kRecordHead + mcap::kFooter - 4), mcap::crc_of(summary));
    if (footer->summary_crc != 0 && footer->summary_crc != crc)
      return {false, "has a damaged index: its checksum is " + std::to_string(crc) + ", must be " +
                         std::to_string(footer->summary_crc)};
    take_index(summary, index);
    return index;
  }

  /// Takes what the summary says; not usable when messages would be missed.
  void take_index(mcap::View summary, Index& index) {
    // Channels need their schemas, whatever the order.
    mcap::for_each_record(summary, [&](mcap::Opcode opcode, mcap::View content, std::size_t) {
      return opcode != mcap::Opcode::schema || describe(opcode, content);
    });
    std::optional<mcap::Statistics> statistics;
    bool whole = mcap::for_each_record(summary, [&](mcap::Opcode opcode, mcap::View content, std::size_t) {
      if (opcode == mcap::Opcode::statistics) return (statistics = mcap::parse_statistics(content)).has_value();
      if (opcode == mcap::Opcode::chunk_index) return add_chunk(content);
      if (opcode == mcap::Opcode::metadata_index) return add_note(content);
      return describe(opcode, content);
    });
    std::ranges::sort(blocks_, {}, &Block::at);
    // A chunk that is listed twice would be read twice.
    for (std::size_t i = 1; i < blocks_.size(); ++i)
      whole = whole && blocks_[i].at - blocks_[i - 1].at >= blocks_[i - 1].size;
    if (!whole) index.damage = "has a damaged index";
    if (!whole || !statistics || statistics->chunk_count != blocks_.size()) return;
    if (statistics->channel_count > channels_.size()) return;  // they are described in the data only
    // Some write such times where there are no messages.
    const auto has_times = [](const auto& extent) { return extent.begin <= extent.end && is_time(extent.end); };
    if (!has_times(*statistics) || !std::ranges::all_of(blocks_, has_times)) return;
    if (blocks_.empty() && statistics->message_count > 0) return;  // they are outside of chunks
    message_count_ = statistics->message_count;
    begin_ = statistics->begin;
    end_ = statistics->end;
    index.is_usable = true;
  }

  bool add_chunk(mcap::View content) {
    const auto index = mcap::parse_chunk_index(content);
    if (!index || !is_within_file(index->chunk_start, index->chunk_length) ||
        !is_readable(index->chunk_start, index->compression))
      return false;
    check_size(index->chunk_start, index->chunk_length);
    blocks_.push_back({.at = index->chunk_start,
                       .size = index->chunk_length,
                       .begin = index->begin,
                       .end = index->end,
                       .is_chunk = true});
    return true;
  }

  bool add_note(mcap::View content) {
    const auto index = mcap::parse_metadata_index(content);
    if (!index || !is_within_file(index->offset, index->length)) return false;
    notes_.push_back({.at = index->offset, .size = index->length});
    return true;
  }

  bool is_within_file(std::uint64_t at, std::uint64_t size) const {
    return size >= kRecordHead && at <= source_->size() && size <= source_->size() - at;
  }

  /// False for a compression with a name that is none; throws Error for all others.
  bool is_readable(std::uint64_t at, std::string_view compression) const {
    if (compression.empty()) return true;
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
    if (std::ranges::all_of(compression, is_letter))
      throw Error(source_->name(),
                  "chunk" + at_byte(at) + " is compressed by " + std::string(compression) +
                      ", must not be compressed; `mcap compress --compression none` makes such a file");
    return false;
  }

  void check_size(std::uint64_t at, std::uint64_t size) const {
    if (size > kMaxRecord)
      throw Error(source_->name(), "record" + at_byte(at) + " has " + std::to_string(size) +
                                       " bytes, must be at most " + std::to_string(kMaxRecord));
  }

  // ---- without an index

  /// Goes through all records.
  void scan(const Index& index) {
    const std::uint64_t size = source_->size();
    Block run;
    std::uint64_t at = mcap::kMagic.size();
    while (damage_.empty()) {
      if (at == size) {
        damage_ = "ends" + at_byte(at) + ", after a whole record: it was not finished";
        break;
      }
      const std::uint64_t rest = size - at;
      const auto head = rest < kRecordHead ? mcap::RecordHead{mcap::Opcode::message, rest}
                                           : mcap::parse_head(window(at, kRecordHead).first<kRecordHead>());
      if (head.opcode == mcap::Opcode{0}) {
        damage_ = "has no record" + at_byte(at) + ", where one must begin";
      } else if (rest < kRecordHead || head.length > rest - kRecordHead) {
        damage_ = "ends" + at_byte(size) + ", within the record that begins" + at_byte(at);
      } else if (head.opcode == mcap::Opcode::footer || head.opcode == mcap::Opcode::data_end) {
        damage_ = damage_at_end(head, at, index);
        break;
      } else {
        scan_record(head, at, run);
        at += kRecordHead + head.length;
      }
    }
    end_run(run);
    drop_what_may_be_no_message();
    for (const Block& block : blocks_) {
      if (block.count == 0) continue;
      begin_ = message_count_ == 0 ? block.begin : std::min(begin_, block.begin);
      end_ = std::max(end_, block.end);
      message_count_ += block.count;
    }
    if (damage_.empty()) damage_ = flaw_;
  }

  /// Who writes chunks writes no messages beside them; what looks like one there is a damaged record of another kind,
  /// unless the checksum of the whole file says that it is not.
  void drop_what_may_be_no_message() {
    const auto is_loose = [](const Block& block) { return !block.is_chunk; };
    const auto first = std::ranges::find_if(blocks_, is_loose);
    if (is_proven_ || first == blocks_.end() || std::ranges::all_of(blocks_, is_loose)) return;
    note_flaw(first->at);
    std::erase_if(blocks_, is_loose);
  }

  void scan_record(const mcap::RecordHead& head, std::uint64_t at, Block& run) {
    const std::uint64_t whole = kRecordHead + head.length;
    if (head.opcode == mcap::Opcode::schema || head.opcode == mcap::Opcode::channel) {
      check_description(at, head.length);
      if (!describe(head.opcode, read(at + kRecordHead, head.length))) note_flaw(at);
    } else if (head.opcode == mcap::Opcode::message) {
      check_size(at, whole);
      std::optional<mcap::Message> message;
      if (head.length >= mcap::kMessageHead)
        message = mcap::parse_message(window(at + kRecordHead, mcap::kMessageHead));
      if (!message || !is_time(message->log_time) || !is_time(message->publish_time)) return note_flaw(at);
      if (run.at + run.size != at || run.size > kRun) end_run(run);
      if (run.size == 0) run.at = at;
      run.size += whole;
      run.add(message->log_time);
    } else if (head.opcode == mcap::Opcode::chunk) {
      scan_chunk(head, at);
    } else if (head.opcode == mcap::Opcode::metadata) {
      notes_.push_back({.at = at, .size = whole});
    }
  }

  void note_flaw(std::uint64_t at) {
    if (flaw_.empty()) flaw_ = "has a damaged record" + at_byte(at);
  }

  void end_run(Block& run) {
    if (run.size > 0) blocks_.push_back(run);
    run = {};
  }

  void scan_chunk(const mcap::RecordHead& head, std::uint64_t at) {
    Block block{.at = at, .size = kRecordHead + head.length, .is_chunk = true};
    check_size(at, block.size);
    if (!parse(block, true)) {
      ++damaged_chunks_;
      return;
    }
    for (const Entry& entry : entries_) block.add(entry.time);
    blocks_.push_back(block);
  }

  /// What is wrong with the file when its data ends with this record, if anything.
  std::string damage_at_end(const mcap::RecordHead& head, std::uint64_t at, const Index& index) {
    if (!index.damage.empty()) return index.damage;
    const bool is_footer = head.opcode == mcap::Opcode::footer;
    const std::uint64_t after = is_footer ? at : at + kRecordHead + head.length;
    if (index.data_end != 0 && after != index.data_end)
      return "has an end of its data" + at_byte(at) + ", must be before byte " + std::to_string(index.data_end);
    return is_footer ? "" : wrong_checksum(at, head.length);
  }

  std::string wrong_checksum(std::uint64_t at, std::uint64_t length) {
    const auto end = mcap::parse_data_end(window(at + kRecordHead, std::min<std::uint64_t>(length, 4)));
    if (!end) return "has a damaged end of its data" + at_byte(at);
    if (end->data_crc == 0) return "";
    std::uint32_t crc = 0;
    for (std::uint64_t done = 0; done < at;) {
      const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(kWindow, at - done));
      crc = mcap::crc_of(window(done, piece), crc);
      done += piece;
    }
    is_proven_ = crc == end->data_crc;
    if (is_proven_) return "";
    return "has damaged bytes before byte " + std::to_string(at) + ": their checksum is " + std::to_string(crc) +
           ", must be " + std::to_string(end->data_crc);
  }

  // ---- both

  /// Remembers a schema or channel, passes over all others; the first one of a number counts. False for a damaged one.
  bool describe(mcap::Opcode opcode, mcap::View content) {
    if (opcode == mcap::Opcode::schema) {
      check_description(0, content.size());
      const auto schema = mcap::parse_schema(content);
      if (!schema) return false;
      if (schema->id == 0 || schemas_.count(schema->id) > 0) return true;
      count_description(content.size());
      schemas_[schema->id] = {std::string(schema->name), std::string(schema->encoding), std::string(schema->data)};
    } else if (opcode == mcap::Opcode::channel) {
      check_description(0, content.size());
      auto channel = mcap::parse_channel(content);
      if (!channel) return false;
      if (channels_.count(channel->id) > 0) return true;
      const auto schema = schemas_.find(channel->schema_id);
      if (channel->schema_id != 0 && schema == schemas_.end()) return true;  // as good as no channel
      const SchemaText text = channel->schema_id == 0 ? SchemaText{} : schema->second;
      count_description(content.size() + text.name.size() + text.encoding.size() + text.data.size());
      channels_[channel->id] = {.topic = std::string(channel->topic),
                                .schema_name = text.name,
                                .definition = text.data,
                                .metadata = std::move(channel->metadata),
                                .schema_encoding = text.encoding,
                                .message_encoding = std::string(channel->message_encoding)};
    }
    return true;
  }

  void check_description(std::uint64_t at, std::uint64_t size) const {
    if (size > mcap::kMaxDescription)
      throw Error(source_->name(), "description of a channel" + (at == 0 ? "" : at_byte(at)) + " has " +
                                       std::to_string(size) + " bytes, must be at most " +
                                       std::to_string(mcap::kMaxDescription));
  }

  void count_description(std::uint64_t size) {
    described_ += size;
    if (described_ > kMaxDescriptions)
      throw Error(source_->name(),
                  "describes its channels with more than " + std::to_string(kMaxDescriptions) + " bytes");
  }

  mcap::Bytes read(std::uint64_t at, std::uint64_t size) const {
    mcap::Bytes bytes(static_cast<std::size_t>(size));
    source_->read(at, bytes);
    return bytes;
  }

  /// `size` bytes from there on, all in the file, at most kWindow; valid until the next call.
  mcap::View window(std::uint64_t at, std::size_t size) {
    if (at < window_at_ || at + size > window_at_ + window_.size()) {
      window_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(kWindow, source_->size() - at)));
      window_at_ = at;
      source_->read(at, window_);
    }
    return mcap::View(window_).subspan(static_cast<std::size_t>(at - window_at_), size);
  }

  /// Reads a block into memory and finds its messages, entries_. False when it is damaged; nothing of it is used then.
  /// describes: schemas and channels in it are news; once the file is open, what is read does not depend on what was.
  bool parse(const Block& block, bool describes) {
    held_at_ = block.at;
    held_.resize(static_cast<std::size_t>(block.size));
    source_->read(block.at, held_);
    entries_.clear();
    mcap::View records(held_);
    if (block.is_chunk) {
      const mcap::RecordHead head = mcap::parse_head(records.first<kRecordHead>());
      if (head.opcode != mcap::Opcode::chunk || head.length != block.size - kRecordHead) return false;
      const auto chunk = mcap::parse_chunk(records.subspan(kRecordHead));
      if (!chunk) return false;
      if (!is_readable(block.at, chunk->compression)) return false;
      if (chunk->uncompressed_crc != 0 && chunk->uncompressed_crc != mcap::crc_of(chunk->records)) return false;
      records = chunk->records;
    }
    const std::uint64_t at = block.at + static_cast<std::uint64_t>(records.data() - held_.data());
    return mcap::for_each_record(records, [&](mcap::Opcode opcode, mcap::View content, std::size_t place) {
      if (opcode != mcap::Opcode::message) return !describes || describe(opcode, content);
      const auto message = mcap::parse_message(content);
      if (!message || !is_time(message->log_time) || !is_time(message->publish_time)) return false;
      entries_.push_back({message->log_time, at + place + kRecordHead, static_cast<std::uint32_t>(content.size())});
      return true;
    });
  }

  void load(Block& block) {
    if (block.is_damaged || block.end < from_) return;
    const auto is_outside = [&](const Entry& entry) { return entry.time < block.begin || entry.time > block.end; };
    if (!parse(block, false) || std::ranges::any_of(entries_, is_outside)) {
      block.is_damaged = true;
      ++damaged_chunks_;
      return;
    }
    for (const Entry& entry : entries_) {
      if (entry.time < from_) continue;
      waiting_.push_back(entry);
      std::ranges::push_heap(waiting_, kLater);
    }
  }

  /// From the block in memory, where most are, or from the file.
  mcap::View content_of(const Entry& entry) {
    if (entry.at >= held_at_ && entry.at + entry.size <= held_at_ + held_.size())
      return mcap::View(held_).subspan(static_cast<std::size_t>(entry.at - held_at_), entry.size);
    message_.resize(entry.size);
    source_->read(entry.at, message_);
    return message_;
  }

  struct SchemaText {
    std::string name{}, encoding{}, data{};
  };

  std::unique_ptr<Source> source_;
  std::map<std::uint16_t, SchemaText> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::uint64_t described_ = 0;
  std::vector<Block> blocks_;  ///< By begin.
  std::vector<Block> notes_;   ///< Records of metadata.
  std::uint64_t begin_ = 0, end_ = 0, message_count_ = 0;
  std::string damage_;
  bool is_proven_ = false;  ///< All of the data by its checksum.
  std::string flaw_;        ///< The first record that is none, where the next one is known.
  std::uint64_t damaged_chunks_ = 0, messages_without_channel_ = 0;

  std::uint64_t from_ = 0;
  std::size_t next_block_ = 0;
  std::vector<Entry> waiting_;  ///< A heap: messages of the blocks that were loaded.
  mcap::Bytes held_, message_, window_;
  std::uint64_t held_at_ = 0, window_at_ = 0;
  std::vector<Entry> entries_;
};

McapReader::McapReader(const std::filesystem::path& file)
    : log_(std::make_unique<Log>(std::make_unique<FileSource>(file.string()))) {}
McapReader::McapReader(std::span<const std::byte> bytes, const std::string& name)
    : log_(std::make_unique<Log>(std::make_unique<MemorySource>(bytes, name))) {}
McapReader::McapReader(McapReader&&) noexcept = default;
McapReader& McapReader::operator=(McapReader&&) noexcept = default;
McapReader::~McapReader() = default;

const std::map<std::uint16_t, McapChannel>& McapReader::channels() const { return log_->channels(); }
std::int64_t McapReader::begin_ns() const { return static_cast<std::int64_t>(log_->begin()); }
std::int64_t McapReader::end_ns() const { return static_cast<std::int64_t>(log_->end()); }
std::uint64_t McapReader::message_count() const { return log_->message_count(); }
std::vector<McapMetadata> McapReader::metadata() const { return log_->metadata(); }
bool McapReader::is_complete() const { return log_->damage().empty(); }
const std::string& McapReader::damage() const { return log_->damage(); }
std::uint64_t McapReader::damaged_chunks() const { return log_->damaged_chunks(); }
std::uint64_t McapReader::messages_without_channel() const { return log_->messages_without_channel(); }
void McapReader::seek(std::int64_t log_time_ns) {
  log_->seek(static_cast<std::uint64_t>(std::max<std::int64_t>(log_time_ns, 0)));
}
std::optional<McapMessage> McapReader::next() { return log_->next(); }

}  // namespace tassilo
