// Text from outside is read or refused with an Error; nothing else happens.
#include <cstdint>
#include <string_view>

#include "tassilo/base/error.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/field_file.h"
#include "tassilo/files/robot_file.h"
#include "tassilo/files/samples_file.h"
#include "tassilo/files/scene_json.h"

using namespace tassilo;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0 || size > 4096) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  try {
    switch (data[0] % 6) {
      case 0:
        camera_from_yaml(text, "fuzz");
        break;
      case 1:
        halcon_camera_from_yaml(text, "fuzz");
        break;
      case 2:
        field_from_yaml(text, "fuzz");
        break;
      case 3:
        robot_from_yaml(text, "fuzz");
        break;
      case 4:
        samples_from_yaml(text, "fuzz");
        break;
      case 5:
        scene_from_json(text);
        break;
    }
  } catch (const Error&) {
  }
  return 0;
}
