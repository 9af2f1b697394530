// Every reader of a YAML file: any bytes are read or refused with an Error, and what was read is written and read back
// alike.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/colors_file.h"
#include "tassilo/files/field_file.h"
#include "tassilo/files/robot_file.h"
#include "tassilo/files/samples_file.h"
#include "tassilo/files/start_state_file.h"

namespace {

using namespace tassilo;

/// Runs a reader; false when it refused.
template <class Read>
bool accepted(Read read) {
  try {
    read();
    return true;
  } catch (const Error&) {
    return false;
  }
}

void camera(std::string_view text) {
  CameraFile first;
  if (!accepted([&] { first = camera_from_yaml(text, "camera.yaml"); })) return;
  const CameraFile second = camera_from_yaml(camera_yaml(first), "again.yaml");
  expects(first.model == second.model && first.mount == second.mount, "a written camera reads back equal");
}

void colors(std::string_view text) {
  accepted([&] { colors_from_yaml(text, "nowhere/colors.yaml"); });
}

void samples(std::string_view text) {
  std::vector<TrainingSample> first;
  if (!accepted([&] { first = samples_from_yaml(text, "data/samples.yaml"); })) return;
  const auto second = samples_from_yaml(samples_yaml(first, "data"), "data/samples.yaml");
  expects(first.size() == second.size(), "written samples read back as many");
  for (std::size_t i = 0; i < first.size(); ++i)
    expects(first[i].color == second[i].color && first[i].frame == second[i].frame &&
                first[i].shape.index() == second[i].shape.index(),
            "written samples read back equal");
}

void field(std::string_view text) {
  FieldModel first;
  if (!accepted([&] { first = field_from_yaml(text, "field.yaml"); })) return;
  expects(field_from_yaml(field_yaml(first), "field.yaml") == first, "a written field reads back equal");
}

void start_state(std::string_view text) {
  StartState first;
  if (!accepted([&] { first = start_state_from_yaml(text, "state.yaml"); })) return;
  const std::string written = start_state_yaml(first);
  expects(start_state_yaml(start_state_from_yaml(written, "again.yaml")) == written,
          "a written state reads back equal");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 1 << 16) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  camera(text);
  colors(text);
  samples(text);
  accepted([&] { halcon_camera_from_yaml(text, "halcon.yaml"); });
  field(text);
  start_state(text);
  accepted([&] { robot_from_yaml(text, "robot.yaml"); });
  return 0;
}
