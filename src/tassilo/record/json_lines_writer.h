#pragma once

#include <string>
#include <string_view>

namespace tassilo {

/// Writes lines to a file or standard output, each at once and as a whole.
///
/// Whenever the program ends, by whatever cause, the file holds complete lines: each goes out in one piece, and what a
/// full disk has taken of one is taken back. One thread at a time.
class JsonLinesWriter {
 public:
  /// `target`: a file, which is replaced, or `-` for standard output. Throws Error when it cannot be opened.
  explicit JsonLinesWriter(const std::string& target);
  JsonLinesWriter(const JsonLinesWriter&) = delete;
  JsonLinesWriter& operator=(const JsonLinesWriter&) = delete;
  ~JsonLinesWriter();

  /// Writes `line` (without line breaks) and a line break. Throws Error when the target takes no more: a full disk, a
  /// reader that has gone (no SIGPIPE reaches the program).
  void write(std::string_view line);

 private:
  std::string name_;
  int fd_;
  std::string buffer_;
};

}  // namespace tassilo
