#include "tassilo/source/line_stream.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

constexpr std::size_t kMaxLine = 4096, kMaxLines = 65536;
constexpr std::string_view kUdp = "udp:";

int port_of(const std::string& location) {
  constexpr std::string_view kHere = "udp:127.0.0.1:";
  int port = 0;
  const char* const end = location.data() + location.size();
  const bool is_here = location.starts_with(kHere);
  const auto [rest, error] =
      is_here ? std::from_chars(location.data() + kHere.size(), end, port) : std::from_chars_result{end, {}};
  constexpr int kLastPort = 65535;
  if (!is_here || error != std::errc{} || rest != end || port < 1 || port > kLastPort)
    throw Error(location, "must be udp:127.0.0.1:PORT with a port of 1.." + std::to_string(kLastPort) +
                              ": only this machine is listened to");
  return port;
}

int open_port(const std::string& location) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port_of(location)));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) throw Error(location, std::string("cannot be listened to: ") + std::strerror(errno));
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return fd;
  const int problem = errno;
  ::close(fd);
  throw Error(location, std::string("cannot be listened to: ") + std::strerror(problem));
}

}  // namespace

class LineStream::Reader {
 public:
  explicit Reader(const std::string& location)
      : is_port_(location != "-"), fd_(is_port_ ? open_port(location) : STDIN_FILENO) {
    thread_ = std::jthread([this](const std::stop_token& stop) { read(stop); });
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() {
    thread_.request_stop();
    thread_.join();
    if (is_port_) ::close(fd_);
  }

  std::vector<std::string> take(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    came_.wait_for(lock, patience, [&] { return over_ || !lines_.empty(); });
    return std::exchange(lines_, {});
  }
  bool over() const {
    const std::lock_guard lock(mutex_);
    return over_;
  }
  std::int64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  void read(const std::stop_token& stop) {
    constexpr int kPatienceMs = 100;  // how long a wish to stop may be overlooked
    std::array<char, 65536> bytes{};  // as large as a datagram may be
    while (!stop.stop_requested()) {
      pollfd watched{fd_, POLLIN, 0};
      if (::poll(&watched, 1, kPatienceMs) <= 0) continue;
      const ssize_t got = ::read(fd_, bytes.data(), bytes.size());
      if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (got <= 0 && !is_port_) break;
      if (got > 0) add({bytes.data(), static_cast<std::size_t>(got)});
      if (is_port_) end_line();
    }
    end_line();
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    came_.notify_one();
  }

  void add(std::string_view text) {
    while (!text.empty()) {
      const auto end = text.find('\n');
      const std::string_view part = text.substr(0, end);
      // One byte too many is kept, to know that it was too long.
      rest_.append(part.substr(0, kMaxLine + 1 - std::min(rest_.size(), kMaxLine + 1)));
      if (end == std::string_view::npos) return;
      text.remove_prefix(end + 1);
      end_line();
    }
  }

  void end_line() {
    std::string line = std::exchange(rest_, {});
    if (line.ends_with('\r')) line.pop_back();
    if (line.empty()) return;
    {
      const std::lock_guard lock(mutex_);
      if (line.size() > kMaxLine) {
        ++dropped_;
        return;
      }
      if (lines_.size() == kMaxLines) {
        lines_.erase(lines_.begin(), lines_.begin() + kMaxLines / 2);
        dropped_ += kMaxLines / 2;
      }
      lines_.push_back(std::move(line));
    }
    came_.notify_one();
  }

  bool is_port_;
  int fd_;
  std::string rest_;  ///< Of a line whose end has not come.
  mutable std::mutex mutex_;
  std::condition_variable came_;
  std::vector<std::string> lines_;
  std::int64_t dropped_ = 0;
  bool over_ = false;
  std::jthread thread_;
};

bool is_line_stream(std::string_view location) { return location == "-" || location.starts_with(kUdp); }

LineStream::LineStream(const std::string& location) : reader_(std::make_unique<Reader>(location)) {}
LineStream::~LineStream() = default;

std::vector<std::string> LineStream::take(std::chrono::milliseconds patience) { return reader_->take(patience); }
bool LineStream::over() const { return reader_->over(); }
std::int64_t LineStream::dropped() const { return reader_->dropped(); }

}  // namespace tassilo
