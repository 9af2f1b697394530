#include "tassilo/record/json_lines_writer.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"

namespace tassilo {
namespace {

/// While alive, a write to a closed pipe gives EPIPE in this thread and no signal, whatever the program has set.
class PipeSignalOff {
 public:
  PipeSignalOff() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    sigset_t pending;
    sigpending(&pending);
    was_pending_ = sigismember(&pending, SIGPIPE) == 1;
    pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  PipeSignalOff(const PipeSignalOff&) = delete;
  PipeSignalOff& operator=(const PipeSignalOff&) = delete;
  ~PipeSignalOff() {
    if (!was_pending_) {
      const timespec now{};
      while (sigtimedwait(&pipe_, nullptr, &now) < 0 && errno == EINTR) continue;
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t pipe_{}, before_{};
  bool was_pending_ = false;
};

}  // namespace

JsonLinesWriter::JsonLinesWriter(const std::string& target)
    : name_(target == "-" ? "standard output" : target),
      fd_(target == "-" ? STDOUT_FILENO : ::open(target.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (fd_ < 0) throw Error(name_, std::string("cannot be opened for writing: ") + std::strerror(errno));
}

JsonLinesWriter::~JsonLinesWriter() {
  if (fd_ != STDOUT_FILENO) ::close(fd_);
}

void JsonLinesWriter::write(std::string_view line) {
  expects(line.find('\n') == std::string_view::npos, "JsonLinesWriter: one line");
  buffer_.assign(line).push_back('\n');
  const PipeSignalOff no_signal;
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t written = ::write(fd_, buffer_.data() + done, buffer_.size() - done);
    if (written >= 0) {
      done += static_cast<std::size_t>(written);
      continue;
    }
    if (errno == EINTR) continue;
    const int problem = errno;
    struct stat status {};
    const bool is_file = ::fstat(fd_, &status) == 0 && S_ISREG(status.st_mode);
    std::string reason = std::string("cannot be written: ") + std::strerror(problem);
    const auto begun = static_cast<off_t>(done);
    if (done > 0 && is_file && ::ftruncate(fd_, status.st_size - begun) != 0) reason += "; its last line is incomplete";
    throw Error(name_, reason);
  }
}

}  // namespace tassilo
