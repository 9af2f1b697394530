#include "tassilo/camera/camera_model.h"

#include "bindings.h"
#include "tassilo/camera/mount.h"
#include "tassilo/field/field_model.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/field_file.h"

namespace tassilo::python {
namespace {

MountedCamera mounted(const CameraFile& camera) {
  if (!camera.mount) refuse("camera", "has no camera_pose_in_robot, must have one for this");
  return {camera.model, *camera.mount};
}

py::object mount_of(const CameraFile& camera) {
  if (!camera.mount) return py::none();
  const CameraMount& m = *camera.mount;
  return py::dict("x"_a = m.x, "y"_a = m.y, "z"_a = m.z, "roll"_a = m.roll, "pitch"_a = m.pitch, "yaw"_a = m.yaw);
}

}  // namespace

void bind_camera(py::module_& module) {
  py::class_<CameraFile>(module, "Camera",
                         "Lens and mount as camera.yaml says: pixel (column, row) to and from metres, robot frame.")
      .def_static(
          "load", [](const std::filesystem::path& path) { return read_camera(path); }, "Reads a camera.yaml.", "path"_a)
      .def_static(
          "from_yaml", [](const std::string& text) { return camera_from_yaml(text, "camera"); },
          "From the text of such a file.", "text"_a)
      .def("to_yaml", &camera_yaml, "The text of such a file.")
      .def_property_readonly("name", [](const CameraFile& c) { return c.model.name; })
      .def_property_readonly("width", [](const CameraFile& c) { return c.model.width; })
      .def_property_readonly("height", [](const CameraFile& c) { return c.model.height; })
      .def_property_readonly("mount", &mount_of, "x, y, z [m], roll, pitch, yaw [rad] in the robot frame, or None.")
      .def(
          "project",
          [](const CameraFile& camera, double x, double y, double z) -> std::optional<std::pair<double, double>> {
            const auto pixel = mounted(camera).project({x, y, z});
            if (!pixel) return std::nullopt;
            return std::pair(pixel->x, pixel->y);
          },
          "Pixel of a point in space, possibly outside the image; None when it cannot show.", "x"_a, "y"_a, "z"_a = 0.0)
      .def(
          "floor_point",
          [](const CameraFile& camera, double column, double row,
             double height) -> std::optional<std::pair<double, double>> {
            const auto point = mounted(camera).floor_point({column, row}, height);
            if (!point) return std::nullopt;
            return std::pair(point->x, point->y);
          },
          "Where the pixel's ray meets the level plane at `height`; None where it does not.", "column"_a, "row"_a,
          "height"_a = 0.0)
      .def("__repr__", [](const CameraFile& c) {
        return "<tassilo.Camera: " + std::to_string(c.model.width) + "x" + std::to_string(c.model.height) + ", " +
               std::string(distortion_name(c.model.distortion)) + (c.mount ? ", mounted>" : ">");
      });

  py::class_<FieldModel>(module, "Field", "The field of a league.")
      .def_static(
          "load", [](const std::string& name) { return read_field(name); },
          "A shipped field by its name (msl98, rcj_soccer, ...), or the path of a YAML file.", "name"_a)
      .def_static(
          "from_yaml", [](const std::string& text) { return field_from_yaml(text, "field"); },
          "From the text of such a file.", "text"_a)
      .def_readonly("name", &FieldModel::name)
      .def_readonly("length", &FieldModel::length, "[m]")
      .def_readonly("width", &FieldModel::width, "[m]")
      .def_readonly("line_width", &FieldModel::line_width, "[m]")
      .def("__repr__", [](const FieldModel& f) { return "<tassilo.Field: " + f.name + ">"; });
}

}  // namespace tassilo::python
