#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "tassilo/base/error.h"
#include "tassilo/source/internal/av_support.h"
#include "tassilo/source/internal/frame_reader.h"
#include "tassilo/source/internal/picture_bytes.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

std::string read_all(const fs::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw Error(path.string(), "cannot be opened");
  std::string bytes(static_cast<std::size_t>(file.tellg()), '\0');
  file.seekg(0);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    throw Error(path.string(), "cannot be read");
  return bytes;
}

/// Lower-case, with its dot.
std::string extension_of(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

bool has_image_extension(const fs::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg";
}

/// img2 before img10: stretches of digits compare as numbers, the rest byte by byte; equal ones (1, 01) by bytes.
bool natural_less(const std::string& a, const std::string& b) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto number_at = [&](const std::string& text, std::size_t at) {
    std::size_t end = at;
    while (end < text.size() && is_digit(text[end])) ++end;
    while (at + 1 < end && text[at] == '0') ++at;
    return std::string_view(text).substr(at, end - at);
  };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view x = number_at(a, i), y = number_at(b, j);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
      while (i < a.size() && is_digit(a[i])) ++i;
      while (j < b.size() && is_digit(b[j])) ++j;
    } else {
      if (a[i] != b[j]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
      ++i, ++j;
    }
  }
  const std::size_t rest_a = a.size() - i, rest_b = b.size() - j;
  return rest_a != rest_b ? rest_a < rest_b : a < b;
}

class ImageReader final : public FrameReader {
 public:
  explicit ImageReader(const SourceOptions& options)
      : name_(options.location),
        range_(options.images_range),
        fps_(options.fps > 0 ? options.fps : 1),
        interrupted_(options.interrupted) {
    if (!fs::is_directory(name_)) {
      files_.emplace_back(name_);
      return;
    }
    try {
      for (const fs::directory_entry& entry : fs::directory_iterator(name_))
        if (entry.is_regular_file() && has_image_extension(entry.path())) files_.push_back(entry.path());
    } catch (const fs::filesystem_error& problem) {
      throw Error(name_, "cannot be listed: " + problem.code().message());
    }
    if (files_.empty()) throw Error(name_, "is a folder without images, must hold .png, .jpg or .jpeg files");
    std::ranges::sort(files_, [](const fs::path& a, const fs::path& b) {
      return natural_less(a.filename().string(), b.filename().string());
    });
  }

  std::optional<Frame> next() override {
    if (next_ == files_.size() || (interrupted_ && interrupted_())) return std::nullopt;
    const fs::path& file = files_[next_];
    const std::string bytes = read_all(file);
    AvFrame picture = decode_image({file.string(), range_}, bytes);
    const std::string layout = av_format_name(*picture);
    Frame frame = frame_from_picture(std::move(picture), {file.string(), range_}, bytes);
    frame.index = static_cast<std::int64_t>(next_);
    frame.t = static_cast<double>(next_) / fps_;
    frame.image = file.filename().string();
    if (next_ == 0) pixels_ = (bytes.starts_with(kPngStart) ? "PNG, " : "JPEG, ") + describe_pixels(layout, frame);
    ++next_;
    return frame;
  }

  SourceInfo info() const override {
    SourceInfo info;
    info.name = name_;
    info.description = pixels_;
    if (files_.size() > 1) info.description = std::to_string(files_.size()) + " images, the first " + pixels_;
    info.frame_count = static_cast<std::int64_t>(files_.size());
    return info;
  }

 private:
  std::string name_;
  ColorRange range_;
  double fps_;
  std::function<bool()> interrupted_;
  std::vector<fs::path> files_;
  std::size_t next_ = 0;
  std::string pixels_;
};

}  // namespace

bool is_image_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 8> start{};
  file.read(start.data(), start.size());
  const std::string_view bytes(start.data(), static_cast<std::size_t>(file.gcount()));
  const std::string extension = extension_of(path);
  const bool is_video = extension == ".mjpeg" || extension == ".mjpg";  // a JPEG after the other
  return bytes.starts_with(kPngStart) || (bytes.starts_with(kJpegStart) && !is_video);
}

std::unique_ptr<FrameReader> make_image_reader(const SourceOptions& options) {
  return std::make_unique<ImageReader>(options);
}

}  // namespace tassilo
