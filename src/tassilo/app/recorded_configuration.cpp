#include "tassilo/app/recorded_configuration.h"

#include <cmath>

#include "tassilo/base/error.h"
#include "tassilo/files/atomic_file.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/colors_file.h"
#include "tassilo/files/field_file.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

/// The root of a square is exact: what gaussian_of made of it comes back.
StartPose start_pose_of(const PoseGaussian& pose) {
  return {pose.x, pose.y, pose.theta, std::sqrt(pose.covariance(0, 0)), std::sqrt(pose.covariance(2, 2))};
}

fs::path copied(const fs::path& file, const fs::path& folder) {
  fs::path target = folder / file.filename();
  std::error_code problem;
  for (int k = 2; fs::exists(target, problem); ++k)
    target = folder / (file.stem().string() + "_" + std::to_string(k) + file.extension().string());
  if (!fs::copy_file(file, target, problem))
    throw Error(target.string(), "cannot be copied from " + file.string() + ": " + problem.message());
  return target;
}

}  // namespace

void write_configuration(const fs::path& folder, const Configuration& configuration,
                         const std::optional<StartState>& state, const std::string& remarks) {
  const RobotSetup& setup = configuration.setup;
  RobotFile robot;
  robot.id = setup.robot.id;
  robot.team = setup.robot.team;
  robot.colors = folder / "colors.yaml";
  write_colors(*robot.colors, {setup.vision.colors, std::nullopt});
  if (setup.vision.camera) {
    robot.camera = folder / "camera.yaml";
    write_camera(*robot.camera, {*setup.vision.camera, setup.vision.mount});
  }
  robot.field = (folder / "field.yaml").string();
  write_atomically(*robot.field, field_yaml(setup.vision.field));
  if (setup.vision.start_pose) robot.start_pose = start_pose_of(*setup.vision.start_pose);
  if (state) {
    robot.start_state = folder / "start_state.yaml";
    write_atomically(*robot.start_state, start_state_yaml(*state));
  }
  for (const NamedFile& file : setup.read)
    if (file.role == "plug-in" || file.role == "--plugin") robot.plugins.push_back(copied(file.path, folder));
  robot.vision = setup.at_work;
  // Last: who sees it finds the others.
  write_atomically(folder / "robot.yaml", remarks + robot_yaml(robot, folder));
}

}  // namespace tassilo
