#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tassilo/image/frame.h"

namespace tassilo {

/// What a camera may be asked to send: packed 4:2:2, 4:2:0 with interleaved chroma, or one JPEG a frame.
enum class CameraFormat { yuyv, uyvy, nv12, mjpeg };

/// Lower-case name, as in options.
std::string_view to_string(CameraFormat format);
/// The format of that name; nothing for another word.
std::optional<CameraFormat> camera_format(std::string_view name);

/// One of the settings that cameras like to change by themselves, which moves the colors: off unless asked for.
struct CameraControl {
  bool automatic = false;
  std::optional<int> value = {};  ///< Nothing: stays what the camera has. Not together with `automatic`.
};

struct CameraOptions {
  int width = 640, height = 480;            ///< Asked for; the camera may answer another size. [px], 1..32767
  double fps = 30;                          ///< Asked for. [1/s], > 0
  std::optional<CameraFormat> format = {};  ///< Nothing: the one that keeps size and rate, packed 4:2:2 first.
  std::optional<ColorRange> range = {};     ///< Of cameras that say it wrong. Nothing: as the camera says.
  CameraControl exposure = {};              ///< [100 us]
  CameraControl gain = {};                  ///< [the camera's own]
  CameraControl white_balance = {};         ///< [K]
  /// Throws Error naming the first field out of range.
  void check() const;
};

/// streaming: frames come; stalled: they stopped coming though the camera is there; unplugged: there is no camera.
enum class CameraState { streaming, stalled, unplugged };

std::string_view to_string(CameraState state);

/// What happened to a camera, once for each change of state.
struct CameraNews {
  CameraState state = CameraState::streaming;
  std::string text;  ///< For people: the camera and what happened.
};

/// Frames that were not delivered, and why. What a camera missed while stalled or unplugged is not known, not counted.
struct CameraCounts {
  std::int64_t lost = 0;      ///< Gaps in the driver's sequence numbers: the driver had no buffer, or the bus failed.
  std::int64_t broken = 0;    ///< Marked as bad by the driver, of a wrong size, or a JPEG that cannot be decoded.
  std::int64_t replaced = 0;  ///< Whole, but a newer one came before anybody took it.
  std::int64_t stalls = 0, unplugged = 0;  ///< How often the state came to be.
};

/// A format in a size, and the highest rate of it. A camera with free sizes has one for the smallest and one for the
/// largest.
struct CameraMode {
  std::string format;         ///< As in options, or the driver's four letters.
  bool usable = false;        ///< One of CameraFormat.
  int width = 0, height = 0;  ///< [px]
  double fps = 0;             ///< 0: not said. [1/s]
};

struct CameraInfo {
  std::string path, name, bus;
  std::string problem;            ///< Why it cannot be asked ("permission denied"); empty: it could.
  std::vector<CameraMode> modes;  ///< In the driver's order.
};

/// The cameras of this machine, by the number of their device; devices that capture nothing are left out. Opens each
/// for a moment, which disturbs nobody who uses it.
std::vector<CameraInfo> list_cameras();

/// Whether a source location names a camera: /dev/video0, /dev/v4l/by-id/..., or any device after `v4l2:`.
bool is_camera(std::string_view location);

}  // namespace tassilo
