#include "tassilo/files/text.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File open_for_reading(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw Error(path.string(), "is a directory, must be a file");
  File file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw Error(path.string(), std::string("cannot be opened: ") + std::strerror(errno));
  return file;
}

/// Appends what one read gives; false at the end of the file.
bool read_some(std::FILE* file, const std::filesystem::path& path, std::string& buffer) {
  std::array<char, 1 << 16> block;
  const std::size_t n = std::fread(block.data(), 1, block.size(), file);
  if (n == 0 && std::ferror(file)) throw Error(path.string(), std::string("cannot be read: ") + std::strerror(errno));
  buffer.append(block.data(), n);
  return n > 0;
}

}  // namespace

std::string read_text(const std::filesystem::path& path, std::size_t max_bytes) {
  const File file = open_for_reading(path);
  std::string text;
  while (read_some(file.get(), path, text))
    if (text.size() > max_bytes)
      throw Error(path.string(), "has more than " + std::to_string(max_bytes) + " bytes, which is the limit");
  return text;
}

LineReader::LineReader(std::filesystem::path file, std::size_t max_bytes)
    : path_(std::move(file)), file_(open_for_reading(path_)), max_bytes_(max_bytes) {}

std::optional<std::string_view> LineReader::next() {
  std::size_t searched = begin_;
  std::size_t end = buffer_.find('\n', searched);
  while (end == std::string::npos && !at_end_ && buffer_.size() - begin_ <= max_bytes_) {
    searched = buffer_.size() - begin_;
    fill();
    end = buffer_.find('\n', searched);
  }
  if (end == std::string::npos) end = buffer_.size();
  if (end == begin_ && end == buffer_.size()) return std::nullopt;
  ++line_;
  if (end - begin_ > max_bytes_)
    throw Error(place(), "has more than " + std::to_string(max_bytes_) + " bytes, which is the limit for a line");
  std::string_view line(buffer_.data() + begin_, end - begin_);
  begin_ = std::min(end + 1, buffer_.size());
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::string LineReader::place() const { return path_.string() + ":" + std::to_string(line_); }

/// Drops what was given and appends the next block.
void LineReader::fill() {
  buffer_.erase(0, begin_);
  begin_ = 0;
  at_end_ = !read_some(file_.get(), path_, buffer_);
}

}  // namespace tassilo
