#include "tassilo/source/frame_source.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "tassilo/base/error.h"
#include "tassilo/source/internal/frame_reader.h"

namespace tassilo {
namespace {

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

bool is_url(const std::string& location) { return location.find("://") != std::string::npos; }

std::unique_ptr<FrameReader> make_reader(const SourceOptions& options) {
  namespace fs = std::filesystem;
  const std::string& location = options.location;
  if (is_camera(location)) {
    if (options.raw) throw Error(location, "is a camera, which says what its frames are");
    return make_camera_reader(options, system_calls());
  }
  const bool is_path = location != "-" && !is_url(location);
  std::error_code ignored;
  if (is_path && !fs::exists(location, ignored)) throw Error(location, "does not exist");
  const bool is_folder = is_path && fs::is_directory(location, ignored);
  const bool is_file = is_path && fs::is_regular_file(location, ignored);
  if (is_file && fs::file_size(location, ignored) == 0) throw Error(location, "is empty, must be a video or an image");
  if (options.raw) {
    if (is_folder) throw Error(location, "is a folder, must be a file or - (standard input) for raw frames");
    return make_raw_reader(options);
  }
  if (is_folder || (is_file && is_image_file(location))) return make_image_reader(options);
  return is_file ? make_stamped_reader(make_video_reader(options), location) : make_video_reader(options);
}

}  // namespace

void check_frame_size(const std::string& subject, int width, int height) {
  if (width < 1 || height < 1 || width > kMaxFrameSize || height > kMaxFrameSize)
    throw Error(subject, "is " + size_text(width, height) + " px, must be 1.." + std::to_string(kMaxFrameSize) +
                             " in both directions");
}

std::string describe_pixels(std::string_view format, const Frame& frame) {
  return std::string(format) + " " + size_text(frame.view.width(), frame.view.height()) + " px, " +
         std::string(to_string(frame.range)) + " range";
}

void RawFormat::check() const {
  check_frame_size("raw frame size", width, height);
  if (!(fps > 0) || !std::isfinite(fps)) throw Error("raw frame rate", "is " + std::to_string(fps) + ", must be > 0");
}

void SourceOptions::check() const {
  if (location.empty()) throw Error("source", "is empty, must be a file, a folder, a URL or - (standard input)");
  if (raw) raw->check();
  camera.check();
  if (!(fps >= 0) || !std::isfinite(fps)) throw Error("source.fps", "is " + std::to_string(fps) + ", must be >= 0");
  if (threads < 1) throw Error("source.threads", "is " + std::to_string(threads) + ", must be >= 1");
}

FrameSource::FrameSource(std::unique_ptr<FrameReader> reader) : reader_(std::move(reader)), first_(reader_->next()) {
  info_ = reader_->info();
  if (!first_) throw Error(info_.name, "holds no complete frame");
  info_.width = first_->view.width();
  info_.height = first_->view.height();
  info_.range = first_->range;
}

FrameSource::FrameSource(FrameSource&&) noexcept = default;
FrameSource& FrameSource::operator=(FrameSource&&) noexcept = default;
FrameSource::~FrameSource() = default;

std::optional<Frame> FrameSource::next() {
  if (first_) return std::exchange(first_, std::nullopt);
  if (damage_) throw *damage_;
  if (over_) return std::nullopt;
  try {
    std::optional<Frame> frame = reader_->next();
    over_ = !frame;
    return frame;
  } catch (const Error& damage) {
    damage_ = damage;
    throw;
  }
}

CameraCounts FrameSource::camera_counts() const { return reader_->counts(); }
std::optional<double> FrameSource::now() const { return reader_->now(); }

FrameSource open_source(const SourceOptions& options) {
  options.check();
  return FrameSource(make_reader(options));
}

std::vector<Frame> read_frames(const SourceOptions& options, std::span<const std::int64_t> indices) {
  std::vector<Frame> frames(indices.size());
  if (indices.empty()) return frames;
  const auto [smallest, largest] = std::ranges::minmax(indices);
  if (smallest < 0) throw Error(options.location, "has no frame " + std::to_string(smallest));
  FrameSource source = open_source(options);
  for (std::int64_t index = 0; index <= largest; ++index) {
    const std::optional<Frame> frame = source.next();
    if (!frame)
      throw Error(source.info().name,
                  "has " + std::to_string(index) + " frames, frame " + std::to_string(largest) + " was asked for");
    for (std::size_t i = 0; i < indices.size(); ++i)
      if (indices[i] == index) frames[i] = *frame;
  }
  return frames;
}

Frame read_frame(const SourceOptions& options, std::int64_t index) {
  return std::move(read_frames(options, std::span(&index, 1)).front());
}

}  // namespace tassilo
