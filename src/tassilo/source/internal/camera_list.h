#pragma once

#include <vector>

#include "tassilo/source/camera.h"
#include "tassilo/source/internal/system_calls.h"

namespace tassilo {

/// See the public one.
std::vector<CameraInfo> list_cameras(SystemCalls& calls);

}  // namespace tassilo
