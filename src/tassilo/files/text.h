#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace tassilo {

/// The whole content of a file. Throws Error when it cannot be read or has more than `max_bytes`.
std::string read_text(const std::filesystem::path& file, std::size_t max_bytes);

/// Reads a text file line by line, in bounded memory.
///
/// The last line needs no line end; a carriage return before it is dropped. Throws Error naming file (and line) when
/// the file cannot be read or a line has more than `max_bytes`.
class LineReader {
 public:
  explicit LineReader(std::filesystem::path file, std::size_t max_bytes = 1 << 20);

  /// The next line without its end, valid until the next call; nothing at the end of the file.
  std::optional<std::string_view> next();
  /// 1-based number of the line that `next` gave last; 0 before.
  int line() const { return line_; }
  /// "file:line" of that line, for messages.
  std::string place() const;

 private:
  void fill();

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::size_t max_bytes_;
  std::string buffer_;  ///< Read but not yet given, from begin_ on.
  std::size_t begin_ = 0;
  bool at_end_ = false;
  int line_ = 0;
};

}  // namespace tassilo
