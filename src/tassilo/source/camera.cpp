#include "tassilo/source/camera.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <utility>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/source/internal/frame_reader.h"

namespace tassilo {
namespace {

constexpr std::array kFormats{CameraFormat::yuyv, CameraFormat::uyvy, CameraFormat::nv12, CameraFormat::mjpeg};

}  // namespace

std::string_view to_string(CameraFormat format) {
  switch (format) {
    case CameraFormat::yuyv:
      return "yuyv";
    case CameraFormat::uyvy:
      return "uyvy";
    case CameraFormat::nv12:
      return "nv12";
    case CameraFormat::mjpeg:
      return "mjpeg";
  }
  broken_promise("a known camera format");
}

std::optional<CameraFormat> camera_format(std::string_view name) {
  for (const CameraFormat format : kFormats)
    if (to_string(format) == name) return format;
  return std::nullopt;
}

std::string_view to_string(CameraState state) {
  switch (state) {
    case CameraState::streaming:
      return "streaming";
    case CameraState::stalled:
      return "stalled";
    case CameraState::unplugged:
      return "unplugged";
  }
  broken_promise("a known camera state");
}

void CameraOptions::check() const {
  check_frame_size("camera.size", width, height);
  constexpr double kMostFps = 10000;
  if (!(fps > 0) || fps > kMostFps)
    throw Error("camera.fps", "is " + std::to_string(fps) + ", must be > 0 and <= " + std::to_string(kMostFps));
  for (const auto& [name, control] : {std::pair{"camera.exposure", exposure}, std::pair{"camera.gain", gain},
                                      std::pair{"camera.white_balance", white_balance}})
    if (control.automatic && control.value)
      throw Error(name, "is automatic and " + std::to_string(*control.value) + ", must be one of them");
}

bool is_camera(std::string_view location) {
  return location.starts_with("v4l2:") || location.starts_with("/dev/video") || location.starts_with("/dev/v4l/");
}

}  // namespace tassilo
