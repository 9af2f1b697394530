#pragma once

#include <string>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/source/internal/system_calls.h"

namespace tassilo {

/// The system refused something; `code` is its errno.
class DeviceError : public Error {
 public:
  DeviceError(const std::string& path, const std::string& action, int error);
  int code() const { return code_; }

 private:
  int code_;
};

/// Whether the errno says that the device is not there any more.
bool is_gone(int code);

/// "no such device": the system's words for an errno, lower-case.
std::string reason_of(int code);

/// An open video device. Closed at the end; one thread at a time.
class V4l2Device {
 public:
  /// Throws DeviceError when it cannot be opened, Error when it is no camera that streams.
  V4l2Device(SystemCalls& calls, std::string path);
  V4l2Device(const V4l2Device&) = delete;
  V4l2Device& operator=(const V4l2Device&) = delete;
  ~V4l2Device() { close(); }

  /// ioctl, again when a signal came between; 0 or the errno.
  int try_ask(unsigned long request, void* argument);
  /// Throws DeviceError(path, action, ...) when refused: "cannot <action>: <reason>".
  void ask(unsigned long request, void* argument, const std::string& action);

  void close();
  bool is_open() const { return fd_ >= 0; }
  int fd() const { return fd_; }
  SystemCalls& calls() const { return calls_; }
  const std::string& path() const { return path_; }
  const std::string& name() const { return name_; }  ///< What the camera calls itself.
  const std::string& bus() const { return bus_; }    ///< Where it is plugged in.

 private:
  void check_capabilities();

  SystemCalls& calls_;
  std::string path_, name_, bus_;
  int fd_;
};

/// Whether the device captures at all; else it is none of ours (the metadata of a camera, an encoder).
class NoCamera : public Error {
 public:
  using Error::Error;
};

}  // namespace tassilo
