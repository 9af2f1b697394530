#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tassilo {

/// Whether a location names a LineStream: `-`, or what begins with `udp:`.
bool is_line_stream(std::string_view location);

/// Lines of text that come while the program runs, from standard input or in datagrams of this machine.
///
/// A thread of its own reads, so that no writer waits and no datagram is lost while the taker is busy. Memory is
/// bounded: of lines that nobody takes at least the newest 32768 are kept. A datagram holds whole lines, the last end
/// may be missing; a line has at most 4096 bytes, a longer one is dropped.
///
/// threads  one at a time
class LineStream {
 public:
  /// location  `-` (standard input) or `udp:127.0.0.1:PORT`, PORT 1..65535; other machines are not listened to.
  /// Throws Error for another location, and when the port cannot be had.
  explicit LineStream(const std::string& location);
  LineStream(const LineStream&) = delete;
  LineStream& operator=(const LineStream&) = delete;
  ~LineStream();

  /// The lines that came since the last call, in order, without their ends; waits up to `patience` for the first one.
  std::vector<std::string> take(std::chrono::milliseconds patience);
  /// Whether no more lines will come: standard input has ended. Ask before `take`.
  bool over() const;
  /// Lines that were too long, or that nobody took.
  std::int64_t dropped() const;

 private:
  class Reader;
  std::unique_ptr<Reader> reader_;
};

}  // namespace tassilo
