#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tassilo/record/mcap_channel.h"

namespace tassilo {

struct McapMessage {
  std::uint16_t channel = 0;
  std::int64_t log_time_ns = 0, publish_time_ns = 0;  ///< Since the UNIX epoch.
  std::uint32_t sequence = 0;
  std::span<const std::byte> data;  ///< Valid until the reader's next call.
};

/// Reads MCAP files, our own and others without compression, in order of log time.
///
/// Where the file has an index it is used, and messages that it does not know (outside of chunks, which the format does
/// not allow then) are not found. Else, and for a file that was cut by a crash, all of it is read once when it is
/// opened. Checksums are verified where the file has them: those of chunks and of the index always, that of the whole
/// file when it is read once anyway.
///
/// memory   one chunk, one message (each at most 256 MiB) and 24 bytes for each message of chunks that overlap in time
///          at one moment; beside it what is known of each chunk, and channels and schemas of at most 64 MiB
/// threads  one at a time
/// source   MCAP format specification, version 0, https://mcap.dev/spec
class McapReader {
 public:
  /// Throws Error when the file cannot be read, is none of MCAP, is compressed, has a record that must be held in
  /// memory of more than 256 MiB, or descriptions of more than 64 MiB.
  explicit McapReader(const std::filesystem::path& file);
  /// The same from memory, which is there as long as the reader; `name` is for errors.
  McapReader(std::span<const std::byte> bytes, const std::string& name);
  McapReader(McapReader&&) noexcept;
  McapReader& operator=(McapReader&&) noexcept;
  ~McapReader();

  /// By the number that messages have: all of them, but for those whose description is damaged. Without index also
  /// those without messages may be missing.
  const std::map<std::uint16_t, McapChannel>& channels() const;
  /// Log time of the first and the last message; 0 without messages.
  std::int64_t begin_ns() const;
  std::int64_t end_ns() const;
  /// As the index says; without index those that were found.
  std::uint64_t message_count() const;
  /// Notes, in file order; those that are damaged are left out. Throws Error for more than 64 MiB.
  std::vector<McapMetadata> metadata() const;

  /// False when the file's end, its index or (without index) its checksum are not as they were written.
  bool is_complete() const;
  /// What is wrong with the file, in words: "ends at byte 400, within the record that begins at byte 300"; empty when
  /// it is complete.
  const std::string& damage() const;
  /// Chunks found so far that are not what was written: left out, reading goes on with the next.
  std::uint64_t damaged_chunks() const;
  /// Messages met so far whose channel the file does not describe: left out.
  std::uint64_t messages_without_channel() const;

  /// Lets the next message be the first at or after this time.
  void seek(std::int64_t log_time_ns);

  /// The next message in order of log time, equal times in file order; nothing after the last one.
  /// Throws Error when the file cannot be read any more.
  std::optional<McapMessage> next();

 private:
  class Log;

  std::unique_ptr<Log> log_;
};

}  // namespace tassilo
