#include "tassilo/vision/vision.h"

#include <memory>
#include <mutex>

#include "bindings.h"
#include "colors.h"
#include "tassilo/app/robot_setup.h"
#include "tassilo/base/error.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/field_file.h"
#include "tassilo/files/scene_json.h"
#include "tassilo/overlay/overlay.h"

namespace tassilo::python {
namespace {

/// Stages move regions by some pixels, which must stay within 16 bit.
constexpr int kMaxVisionSize = 32000;

/// A Vision with its workspace, and the lock that lets one thread at a time use it.
struct PythonVision {
  PythonVision(const VisionSetup& setup, const StageRegistry& registry) : vision(setup, registry) {}

  Vision vision;
  VisionWorkspace workspace = {};
  std::mutex mutex = {};
};
using SharedVision = std::shared_ptr<PythonVision>;

VisionOptions options_of(const py::dict& values) {
  std::vector<std::pair<std::string, Setting>> settings;
  for (const auto& [key, value] : values) {
    const auto name = py::str(key).cast<std::string>();
    const bool is_text = py::isinstance<py::str>(value);
    settings.emplace_back(name, Setting{.place = "options",
                                        .name = "vision." + name,
                                        .text = py::str(value).cast<std::string>(),
                                        .quoted = is_text});
  }
  try {
    return vision_options(settings);
  } catch (const Error& error) {
    throw py::value_error(error.what());
  }
}

bool is_path(const py::object& object) { return py::isinstance<py::str>(object) || py::hasattr(object, "__fspath__"); }

SharedVision vision_from_parts(const py::object& colors, const py::object& camera, const py::object& field,
                               const py::dict& options) {
  VisionSetup setup;
  setup.colors = is_path(colors) ? read_colors(colors.cast<std::filesystem::path>()).table
                                 : as<const Colors&>("colors", colors, "a ColorTable or a path").file.table;
  setup.field = is_path(field) ? read_field(field.cast<std::filesystem::path>().string())
                               : as<const FieldModel&>("field", field, "a Field, a name or a path");
  if (!camera.is_none()) {
    const CameraFile file = is_path(camera) ? read_camera(camera.cast<std::filesystem::path>())
                                            : as<const CameraFile&>("camera", camera, "a Camera or a path");
    if (!file.mount)
      refuse("camera", "has no camera_pose_in_robot, must have one; without a mount leave the camera out");
    setup.camera = file.model;
    setup.mount = file.mount;
  }
  setup.options = options_of(options);
  py::gil_scoped_release unlocked;
  return std::make_shared<PythonVision>(setup, built_in_stages());
}

SharedVision vision_from_robot(const std::filesystem::path& path, const std::optional<std::filesystem::path>& colors) {
  py::gil_scoped_release unlocked;
  const RobotSetup setup = read_robot_setup(path.string(), colors ? colors->string() : "");
  return std::make_shared<PythonVision>(setup.vision, setup.registry);
}

void check_frame(const Frame& frame) {
  const FrameView& view = frame.view;
  if (view.width() > kMaxVisionSize || view.height() > kMaxVisionSize)
    refuse("frame", "is " + std::to_string(view.width()) + "x" + std::to_string(view.height()) +
                        ", must be at most 32000 in each direction");
}

py::dict see(PythonVision& self, const Frame& frame) {
  check_frame(frame);
  std::string line;
  {
    py::gil_scoped_release unlocked;
    const std::lock_guard only(self.mutex);
    self.workspace.history.clear();  // each frame by itself, whichever thread brings it
    line = to_json_line(self.vision(frame, self.workspace));
  }
  return py::module_::import("json").attr("loads")(line);
}

py::array_t<std::uint8_t> draw(const PythonVision& self, const Frame& frame, const py::dict& scene, int scale,
                               bool bird_view) {
  check_frame(frame);
  OverlayOptions options;
  const Optics* optics = self.vision.optics();
  options.camera = optics != nullptr ? &optics->camera : nullptr;
  options.scale = scale;
  options.bird_view = bird_view;
  try {
    options.check();
  } catch (const Error& error) {
    throw py::value_error(error.what());
  }
  const auto line = py::module_::import("json").attr("dumps")(scene).cast<std::string>();
  Picture picture;
  {
    py::gil_scoped_release unlocked;
    picture = draw_overlay(frame.view, frame.range, scene_from_json(line), options);
  }
  return array_of(std::move(picture.pixels), {picture.height, picture.width, 3});
}

py::list list_of(const std::vector<OptionInfo>& infos) {
  py::list list;
  for (const OptionInfo& info : infos)
    list.append(py::dict("key"_a = std::string(info.key), "default"_a = info.standard, "low"_a = info.low,
                         "high"_a = info.high, "whole"_a = info.whole, "unit"_a = std::string(info.unit),
                         "meaning"_a = std::string(info.meaning)));
  return list;
}

py::list stage_list() {
  py::list list;
  for (const StageInfo& info : stage_infos(built_in_stages())) {
    py::list alternatives;
    for (const StageInfo::Alternative& way : info.alternatives)
      alternatives.append(py::dict("name"_a = way.name, "meaning"_a = way.meaning, "options"_a = list_of(way.options)));
    list.append(py::dict("key"_a = std::string(info.key), "meaning"_a = std::string(info.meaning),
                         "alternatives"_a = alternatives, "options"_a = list_of(info.options)));
  }
  return list;
}

}  // namespace

void bind_vision(py::module_& module) {
  py::class_<PythonVision, SharedVision>(module, "Vision", R"(The whole vision of one robot: vision(frame) is a scene.

From parts: the color table and, for everything in metres, camera and field; each the object or the path of its file
(field also the name of a shipped one). options: as below `vision:` in robot.yaml, see vision_options, and
stages for those that are names.)")
      .def(py::init(&vision_from_parts), "From parts.", "colors"_a, "camera"_a = py::none(), "field"_a = "msl98",
           "options"_a = py::dict())
      .def_static("from_robot", &vision_from_robot,
                  "From a robot.yaml and the files it names; `colors` takes the place of its color table.", "path"_a,
                  "colors"_a = py::none())
      .def("__call__", &see,
           "Sees one frame: a dict with the keys of a line of `tassilo run --output` (schema/scene.schema.json). "
           "Each frame is seen by itself: the pose is what it alone shows. "
           "Raises tassilo.Error for frames of another size or color range than camera and table are for.",
           "frame"_a)
      .def("draw", &draw,
           "The frame with what was seen in it, beside it the view from above: (height, width, 3) of R, G, B.",
           "frame"_a, "scene"_a, "scale"_a = 0, "bird_view"_a = true);
  module.def(
      "vision_options", [] { return list_of(vision_option_infos()); },
      "The options of Vision: key, default, low, high, whole, unit, meaning.");
  module.def(
      "stages", &stage_list,
      "The stages of Vision in the order they run: key, meaning, options as in vision_options, and alternatives, "
      "the default first: name, meaning, options of their own. One is chosen by the option key=name.");
}

}  // namespace tassilo::python
