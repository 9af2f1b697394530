#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/source/internal/frame_reader.h"

namespace tassilo {
namespace {

using PlaneSizes = std::array<std::size_t, 3>;  ///< [bytes]

PlaneSizes plane_sizes(const FrameBuffer& buffer) {
  const FrameView& view = buffer.frame.view;
  const bool halved_rows = view.format() == PixelFormat::yuv420p || view.format() == PixelFormat::nv12;
  const int chroma_rows = halved_rows ? (view.height() + 1) / 2 : view.height();
  PlaneSizes sizes{};
  for (std::size_t p = 0; p < sizes.size(); ++p)
    sizes[p] = static_cast<std::size_t>(buffer.strides[p] * (p == 0 ? view.height() : chroma_rows));
  return sizes;
}

/// A file descriptor that is closed unless it is standard input.
class Input {
 public:
  explicit Input(const std::string& location)
      : fd_(location == "-" ? STDIN_FILENO : ::open(location.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (fd_ < 0) throw Error(location, std::string("cannot be opened: ") + std::strerror(errno));
  }
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;
  ~Input() {
    if (fd_ != STDIN_FILENO) ::close(fd_);
  }

  /// Size of a regular file. [bytes]
  std::optional<std::int64_t> size() const {
    struct stat status {};
    if (::fstat(fd_, &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return status.st_size;
  }

  /// Fills `bytes` as far as the data goes; less only at the end or when `interrupted` says so.
  std::size_t read(std::span<std::uint8_t> bytes, const std::string& name, const std::function<bool()>& interrupted) {
    std::size_t done = 0;
    while (done < bytes.size()) {
      if (interrupted && !wait_for_data(interrupted)) break;
      const ssize_t got = ::read(fd_, bytes.data() + done, bytes.size() - done);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw Error(name, std::string("cannot be read: ") + std::strerror(errno));
      if (got == 0) break;
      done += static_cast<std::size_t>(got);
    }
    return done;
  }

 private:
  /// False when interrupted.
  bool wait_for_data(const std::function<bool()>& interrupted) const {
    constexpr int kPollMs = 100;
    while (!interrupted()) {
      pollfd watched{fd_, POLLIN, 0};
      const int ready = ::poll(&watched, 1, kPollMs);
      // A signal that ends the waiting brings no data: to read then would wait for it, deaf to `interrupted`.
      if (ready > 0 || (ready < 0 && errno != EINTR)) return true;
    }
    return false;
  }

  int fd_;
};

class RawReader final : public FrameReader {
 public:
  explicit RawReader(const SourceOptions& options)
      : name_(options.location == "-" ? "standard input" : options.location),
        format_(options.raw.value()),
        interrupted_(options.interrupted),
        input_(options.location) {}

  std::optional<Frame> next() override {
    FrameBuffer buffer = make_frame_buffer(format_.format, format_.width, format_.height, format_.range);
    const PlaneSizes sizes = plane_sizes(buffer);
    const std::size_t wanted = sizes[0] + sizes[1] + sizes[2];
    std::size_t got = 0;
    for (std::size_t p = 0; p < sizes.size(); ++p) {
      const std::size_t part = input_.read({buffer.planes[p], sizes[p]}, name_, interrupted_);
      got += part;
      if (part < sizes[p]) break;
    }
    if (got < wanted) {
      const bool asked_to_stop = interrupted_ && interrupted_();
      if (got == 0 || asked_to_stop) return std::nullopt;
      throw Error(name_, "frame " + std::to_string(next_index_) + " is cut short: " + std::to_string(got) +
                             " bytes, must be " + std::to_string(wanted) + " (" +
                             std::string(to_string(format_.format)) + " " + std::to_string(format_.width) + "x" +
                             std::to_string(format_.height) + ")");
    }
    buffer.frame.index = next_index_++;
    buffer.frame.t = static_cast<double>(buffer.frame.index) / format_.fps;
    return std::move(buffer.frame);
  }

  SourceInfo info() const override {
    FrameBuffer shape = make_frame_buffer(format_.format, format_.width, format_.height, format_.range);
    const PlaneSizes sizes = plane_sizes(shape);
    SourceInfo info;
    info.name = name_;
    info.description = "raw " + describe_pixels(to_string(format_.format), shape.frame);
    if (const auto size = input_.size())
      info.frame_count = *size / static_cast<std::int64_t>(sizes[0] + sizes[1] + sizes[2]);
    return info;
  }

 private:
  std::string name_;
  RawFormat format_;
  std::function<bool()> interrupted_;
  Input input_;
  std::int64_t next_index_ = 0;
};

}  // namespace

std::unique_ptr<FrameReader> make_raw_reader(const SourceOptions& options) {
  return std::make_unique<RawReader>(options);
}

}  // namespace tassilo
