#pragma once

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

namespace tassilo {

/// "frame 12 of 40  35.2 frames/s", rewritten in place on a terminal.
class Progress {
 public:
  Progress(bool wanted, std::optional<std::int64_t> frames)
      : shown_(wanted && isatty(STDERR_FILENO) == 1), frames_(frames) {}

  void frame(std::int64_t done) {
    const auto now = std::chrono::steady_clock::now();
    if (!shown_ || now < next_) return;
    next_ = now + std::chrono::milliseconds(100);
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double rate = seconds > 0 ? static_cast<double>(done) / seconds : 0;
    std::string text = fmt::format("\rframe {}", done);
    if (frames_ && *frames_ > 0) {
      constexpr int width = 24;
      const int full = static_cast<int>(std::min<std::int64_t>(width, width * done / *frames_));
      text += fmt::format(" of {}  [{:#<{}}{:.<{}}]", *frames_, "", full, "", width - full);
    }
    fmt::print(stderr, "{}  {:.1f} frames/s   ", text, rate);
  }
  /// Gives the line back to other messages, for a while.
  void clear() const {
    if (shown_) std::fprintf(stderr, "\r%78s\r", "");
  }
  void finish() {
    clear();
    shown_ = false;
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() { finish(); }

 private:
  bool shown_;
  std::optional<std::int64_t> frames_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), next_ = start_;
};

}  // namespace tassilo
