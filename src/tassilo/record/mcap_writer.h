#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "tassilo/record/mcap_channel.h"

namespace tassilo {

/// When a chunk is complete and goes out. What was not yet flushed is what a crash takes.
struct McapOptions {
  std::size_t chunk_bytes = std::size_t{1} << 20;  ///< A chunk of this size is complete. [bytes] 1 .. 64 MiB
  double chunk_seconds = 1;  ///< A chunk whose messages are so far apart in log time is complete. [s] 0 .. 3600
  /// Throws Error naming the first field out of range.
  void check() const;
};

/// Writes messages with their times into one file that Foxglove, PlotJuggler and `ros2 bag` open: an MCAP file, profile
/// "ros2", with an index at its end, without compression.
///
/// A chunk goes to the kernel as a whole, in one write, when it is complete, with the schemas and channels that were
/// not in the file before. So whenever the program ends, by whatever cause, the file can be read up to its last
/// complete chunk; what is lost are messages since then, at most McapOptions apart. A chunk is completed by a message;
/// where messages may stay away for long, call `flush`.
///
/// Times are nanoseconds since the UNIX epoch; log times may come in any order, files are quickest to read when they
/// grow.
///
/// threads  one at a time
/// source   MCAP format specification, version 0, https://mcap.dev/spec
class McapWriter {
 public:
  /// Makes the file. Throws Error when it is there already (nothing is overwritten) or cannot be written.
  explicit McapWriter(const std::filesystem::path& file, const McapOptions& options = {});
  McapWriter(McapWriter&&) noexcept;
  McapWriter& operator=(McapWriter&&) noexcept;
  /// Finishes as far as it can; what fails then is lost, so call `finish`.
  ~McapWriter();

  /// Gives the number under which messages of a new channel are written. A schema that is equal to one of another
  /// channel is written once. Throws Error after 65535 channels, or when the texts of this one have more than 16 MiB.
  std::uint16_t add_channel(const McapChannel& channel);

  /// Adds a message of at most 128 MiB; counts the sequence of its channel, from 0. Throws Error when the disk takes no
  /// more, or for a time before 1970. The file then ends with its last whole chunk; all later messages are refused
  /// alike, and `finish` can still complete it.
  void write(std::uint16_t channel, std::int64_t log_time_ns, std::int64_t publish_time_ns,
             std::span<const std::byte> message);

  /// Completes the chunk at work and hands it to the kernel. Throws Error as `write` does.
  void flush();

  /// Writes a note at once. Throws Error as `write` does, and for more than 16 MiB.
  void add_metadata(const std::string& name, const McapPairs& pairs);

  /// Writes what is left and the index; nothing may be written afterwards. Throws Error when the disk is full: the file
  /// is then one that was not finished. May be called again.
  void finish();

  /// In the file, or on the way there.
  std::int64_t bytes() const;

 private:
  class File;

  std::unique_ptr<File> file_;
};

}  // namespace tassilo
