// Any line is a scene or refused with an Error; a scene that was read is written as a line that reads back as the same
// line.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/files/scene_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 1 << 16) return 0;
  using namespace tassilo;
  Scene scene;
  try {
    scene = scene_from_json({reinterpret_cast<const char*>(data), size});
  } catch (const Error&) {
    return 0;
  }
  const std::string line = to_json_line(scene);
  expects(to_json_line(scene_from_json(line)) == line, "a line that was read is written alike");
  return 0;
}
