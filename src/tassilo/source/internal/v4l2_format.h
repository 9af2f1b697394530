#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tassilo/source/camera.h"
#include "tassilo/source/internal/v4l2_device.h"

namespace tassilo {

/// What a camera agreed to send.
struct AgreedFormat {
  CameraFormat format = CameraFormat::yuyv;
  int width = 0, height = 0;    ///< [px]
  std::ptrdiff_t stride = 0;    ///< Of the packed rows or of the Y plane. 0 for mjpeg. [bytes]
  std::size_t least_bytes = 0;  ///< A frame with fewer is broken.
  ColorRange range = ColorRange::limited;
  double fps = 0;  ///< 0: the driver does not say. [1/s]
  friend bool operator==(const AgreedFormat&, const AgreedFormat&) = default;
};

/// "yuyv 640x480 px, limited range, 30 frames/s"
std::string to_string(const AgreedFormat& format);

/// Asks for size, rate and format, and takes what the camera answers.
///
/// Without a wanted format: the nearest size first, then the wanted rate, then yuyv, uyvy, nv12, mjpeg.
/// Throws Error when the camera has none of our formats, sends half frames, or says that its colors are not BT.601;
/// DeviceError when the system refuses.
AgreedFormat agree_on_format(V4l2Device& device, const CameraOptions& options);

/// The pixels of a frame that is not mjpeg; `bytes` has at least format.least_bytes.
FrameView view_of(const AgreedFormat& format, const std::uint8_t* bytes);

/// All that the camera offers, in its order.
std::vector<CameraMode> modes_of(V4l2Device& device);

}  // namespace tassilo
