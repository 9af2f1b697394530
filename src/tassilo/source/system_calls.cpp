#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <ctime>

#include "tassilo/source/internal/system_calls.h"

namespace tassilo {
namespace {

double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

class RealSystemCalls final : public SystemCalls {
 public:
  int open(const std::string& path) override { return ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC); }
  void close(int fd) override { ::close(fd); }
  int ioctl(int fd, unsigned long request, void* argument) override { return ::ioctl(fd, request, argument); }
  void* map(int fd, std::size_t length, std::int64_t offset) override {
    void* const memory = ::mmap(nullptr, length, PROT_READ, MAP_SHARED, fd, offset);
    return memory == MAP_FAILED ? nullptr : memory;
  }
  void unmap(void* memory, std::size_t length) override { ::munmap(memory, length); }
  int poll(int fd, int timeout_ms) override {
    pollfd watched{fd, POLLIN, 0};
    const int ready = ::poll(&watched, 1, timeout_ms);
    return ready > 0 ? watched.revents : ready;
  }
  double monotonic_s() override { return seconds_of(CLOCK_MONOTONIC); }
  double realtime_s() override { return seconds_of(CLOCK_REALTIME); }
};

}  // namespace

SystemCalls& system_calls() {
  static RealSystemCalls calls;
  return calls;
}

}  // namespace tassilo
