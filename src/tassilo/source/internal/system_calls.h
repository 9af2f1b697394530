#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace tassilo {

/// What a camera needs of the operating system, so that tests can be a driver. Answers and `errno` are the system's.
///
/// threads  any, as the system's
class SystemCalls {
 public:
  SystemCalls() = default;
  SystemCalls(const SystemCalls&) = delete;
  SystemCalls& operator=(const SystemCalls&) = delete;
  virtual ~SystemCalls() = default;

  /// For reading and writing, never waiting. -1: errno.
  virtual int open(const std::string& path) = 0;
  virtual void close(int fd) = 0;
  virtual int ioctl(int fd, unsigned long request, void* argument) = 0;
  /// Readable shared memory of a device. nullptr: errno.
  virtual void* map(int fd, std::size_t length, std::int64_t offset) = 0;
  virtual void unmap(void* memory, std::size_t length) = 0;
  /// The poll events of fd (negative: just waits), 0 when time is up, -1: errno. [ms]
  virtual int poll(int fd, int timeout_ms) = 0;
  virtual double monotonic_s() = 0;  ///< The clock of drivers' time stamps.
  virtual double realtime_s() = 0;   ///< Since the UNIX epoch.
};

/// The real ones.
SystemCalls& system_calls();

}  // namespace tassilo
