#include <cerrno>

#include "tassilo/source/internal/camera_list.h"
#include "tassilo/source/internal/v4l2_format.h"

namespace tassilo {

std::vector<CameraInfo> list_cameras(SystemCalls& calls) {
  constexpr int kMostDevices = 256;  // VIDEO_NUM_DEVICES of Linux
  std::vector<CameraInfo> cameras;
  for (int number = 0; number < kMostDevices; ++number) {
    CameraInfo camera;
    camera.path = "/dev/video" + std::to_string(number);
    try {
      V4l2Device device(calls, camera.path);
      camera.name = device.name();
      camera.bus = device.bus();
      camera.modes = modes_of(device);
    } catch (const DeviceError& refusal) {
      if (is_gone(refusal.code())) continue;
      camera.problem = reason_of(refusal.code());
    } catch (const NoCamera&) {
      continue;
    } catch (const Error& fault) {
      camera.problem = fault.what();
    }
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

std::vector<CameraInfo> list_cameras() { return list_cameras(system_calls()); }

}  // namespace tassilo
