#include "tassilo/app/robot_setup.h"

#include <algorithm>
#include <filesystem>

#include "tassilo/app/plugin.h"
#include "tassilo/base/error.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/colors_file.h"
#include "tassilo/files/field_file.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

/// The path of a file that the robot file names below `key`.
std::string named_file(const std::string& robot_file, const std::string& key, const fs::path& path,
                       const std::string& remedy) {
  std::error_code ignored;
  if (!fs::exists(path, ignored))
    throw Error(robot_file, "names " + path.string() + " as " + key + ", which does not exist" + remedy);
  return path.string();
}

FieldModel named_field(const std::string& robot_file, const std::string& field) {
  if (is_field_path(field)) return read_field(named_file(robot_file, "field", field, ""));
  try {
    return read_field(field);
  } catch (const Error& error) {
    throw Error(robot_file, error.what());
  }
}

}  // namespace

PoseGaussian gaussian_of(const StartPose& start) {
  return pose_gaussian(start.x, start.y, start.theta, start.sigma_xy, start.sigma_theta);
}

StageRegistry registry_of(const RobotFile& robot, const std::string& robot_file, std::span<const std::string> plugins) {
  std::vector<std::string> files;
  for (const fs::path& plugin : robot.plugins) files.push_back(named_file(robot_file, "a plug-in", plugin, ""));
  files.insert(files.end(), plugins.begin(), plugins.end());
  return with_plugins(built_in_stages(), files);
}

RobotSetup read_robot_setup(const std::string& robot_file, const std::string& colors,
                            std::span<const std::string> plugins) {
  const RobotFile robot = robot_file.empty() ? RobotFile{} : read_robot(robot_file);
  RobotSetup setup;
  setup.read.push_back({"robot file", robot_file});

  if (colors.empty() && !robot.colors)
    throw Error(robot_file.empty() ? "colors" : robot_file,
                "no color table: give --colors FILE, or `colors:` in the robot file; `tassilo train colors` makes one");
  const std::string table = !colors.empty()
                                ? colors
                                : named_file(robot_file, "colors", *robot.colors,
                                             "; `tassilo train colors` makes one, --colors FILE takes another");
  setup.read.push_back({kColorsRole, table});
  setup.read.push_back({"PNG of the color table", table_paths(table).now.string()});
  setup.vision.colors = read_colors(table).table;

  if (robot.camera) {
    const std::string file = named_file(robot_file, "camera", *robot.camera, "");
    const CameraFile camera = read_camera(file);
    if (!camera.mount)
      throw Error(file,
                  "has no camera_pose_in_robot; add `camera_pose_in_robot: {x: .., y: .., z: .., roll: .., pitch: .., "
                  "yaw: ..}` in m and rad, or leave `camera:` out of the robot file");
    if (!robot.field)
      throw Error(robot_file, "has a camera but no `field:`; sizes of ball, goals and lines are needed on the floor");
    setup.vision.camera = camera.model;
    setup.vision.mount = camera.mount;
    setup.read.push_back({kCameraRole, file});
  }
  // Without a field file: whatever may be there, in the image alone.
  setup.vision.field = robot.field ? named_field(robot_file, *robot.field) : read_field("msl98");
  if (robot.field && is_field_path(*robot.field)) setup.read.push_back({"field file", *robot.field});
  for (const fs::path& plugin : robot.plugins) setup.read.push_back({"plug-in", plugin.string()});
  for (const std::string& plugin : plugins) setup.read.push_back({"--plugin", plugin});
  setup.registry = registry_of(robot, robot_file, plugins);
  setup.settings = setup.at_work = robot.vision;
  setup.vision.options = vision_options(setup.settings, setup.registry);
  if (robot.start_pose) setup.vision.start_pose = gaussian_of(*robot.start_pose);
  if (robot.start_state) {
    const std::string file = named_file(robot_file, "start_state", *robot.start_state, "");
    setup.start_state = read_start_state(file);
    setup.read.push_back({"start state", file});
  }
  setup.robot = robot;
  return setup;
}

bool see_alike(const RobotSetup& a, const RobotSetup& b) {
  const VisionSetup &x = a.vision, &y = b.vision;
  const bool has_plugins = std::ranges::any_of(
      a.read, [](const NamedFile& file) { return file.role == "plug-in" || file.role == "--plugin"; });
  const auto text_of = [](const auto& setting) { return std::pair(setting.first, setting.second.text); };
  return !has_plugins && std::ranges::equal(a.settings, b.settings, {}, text_of, text_of) &&
         a.robot.plugins == b.robot.plugins && x.colors == y.colors && x.field == y.field && x.camera == y.camera &&
         x.mount == y.mount && x.options.stages == y.options.stages &&
         option_values(x.options) == option_values(y.options);
}

}  // namespace tassilo
