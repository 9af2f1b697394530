#include "tassilo/source/internal/v4l2_device.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <utility>

namespace tassilo {
namespace {

/// Texts of drivers have a fixed length and need not end.
template <std::size_t N>
std::string text_of(const __u8 (&text)[N]) {
  const auto* const begin = reinterpret_cast<const char*>(text);
  return {begin, std::find(begin, begin + N, '\0')};
}

}  // namespace

std::string reason_of(int code) {
  std::string text = std::strerror(code);
  if (text.size() > 1 && std::islower(static_cast<unsigned char>(text[1])))
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

bool is_gone(int code) { return code == ENODEV || code == ENXIO || code == ENOENT || code == EBADF; }

DeviceError::DeviceError(const std::string& path, const std::string& action, int error)
    : Error(path,
            "cannot " + action + ": " + reason_of(error) + (error == EBUSY ? "; another program may be using it" : "")),
      code_(error) {}

V4l2Device::V4l2Device(SystemCalls& calls, std::string path)
    : calls_(calls), path_(std::move(path)), fd_(calls_.open(path_)) {
  if (fd_ < 0) throw DeviceError(path_, "be opened as a camera", errno);
  try {
    check_capabilities();
  } catch (...) {
    close();
    throw;
  }
}

void V4l2Device::check_capabilities() {
  v4l2_capability about{};
  const int code = try_ask(VIDIOC_QUERYCAP, &about);
  if (code == ENOTTY || code == EINVAL) throw NoCamera(path_, "is no video device, must be a camera");
  if (code != 0) throw DeviceError(path_, "say what it is", code);
  name_ = text_of(about.card);
  bus_ = text_of(about.bus_info);
  const __u32 can = (about.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? about.device_caps : about.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0)
    throw Error(path_, "(" + name_ +
                           ") delivers its planes apart, which is not supported; pipe its frames in as raw ones on "
                           "standard input");
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0)
    throw NoCamera(path_, "(" + name_ + ") captures no video, must be a camera; another number may be the camera");
  if ((can & V4L2_CAP_STREAMING) == 0)
    throw Error(path_, "(" + name_ + ") does not share its memory, must be a camera that streams");
}

int V4l2Device::try_ask(unsigned long request, void* argument) {
  while (calls_.ioctl(fd_, request, argument) < 0)
    if (errno != EINTR) return errno;
  return 0;
}

void V4l2Device::ask(unsigned long request, void* argument, const std::string& action) {
  const int code = try_ask(request, argument);
  if (code != 0) throw DeviceError(path_, action, code);
}

void V4l2Device::close() {
  if (fd_ >= 0) calls_.close(std::exchange(fd_, -1));
}

}  // namespace tassilo
