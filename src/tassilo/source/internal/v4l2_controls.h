#pragma once

#include <string>

#include "tassilo/source/camera.h"
#include "tassilo/source/internal/v4l2_device.h"

namespace tassilo {

/// Sets exposure, gain and white balance as asked, reads back what became of it.
///
/// returns  for people: "exposure 156 fixed, gain 64 fixed (asked for 500, must be 0..64), no white balance"
/// Throws Error when a value or "automatic" was asked for that the camera does not have, DeviceError when it is gone.
std::string apply_controls(V4l2Device& device, const CameraOptions& options);

}  // namespace tassilo
