// Text from outside is read or refused with an Error; nothing else happens. Shipped YAML files are good seeds.
#include <cstdint>
#include <string_view>

#include "tassilo/base/error.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/field_file.h"
#include "tassilo/files/robot_file.h"
#include "tassilo/files/samples_file.h"
#include "tassilo/files/scene_json.h"

using namespace tassilo;

namespace {

template <class Read>
void read_or_refuse(Read read) {
  try {
    read();
  } catch (const Error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 4096) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_or_refuse([&] { camera_from_yaml(text, "fuzz"); });
  read_or_refuse([&] { halcon_camera_from_yaml(text, "fuzz"); });
  read_or_refuse([&] { field_from_yaml(text, "fuzz"); });
  read_or_refuse([&] { robot_from_yaml(text, "fuzz"); });
  read_or_refuse([&] { samples_from_yaml(text, "fuzz"); });
  read_or_refuse([&] { scene_from_json(text); });
  return 0;
}
