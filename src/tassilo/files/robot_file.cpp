#include "tassilo/files/robot_file.h"

#include <array>
#include <numbers>

#include "tassilo/files/field_file.h"
#include "tassilo/files/yaml.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

StartPose start_pose_of(const Value& value) {
  const Map map = value.map({"x", "y", "theta", "sigma_xy", "sigma_theta"});
  StartPose pose;
  pose.x = map.at("x").number();
  pose.y = map.at("y").number();
  pose.theta = map.at("theta").number(-2 * std::numbers::pi, 2 * std::numbers::pi);
  if (const auto sigma = map.find("sigma_xy")) pose.sigma_xy = sigma->positive();
  if (const auto sigma = map.find("sigma_theta")) pose.sigma_theta = sigma->positive();
  return pose;
}

void read_identity(const Value& value, RobotFile& robot) {
  constexpr std::array<std::string_view, 2> kTeams{"cyan", "magenta"};
  const Map map = value.map({"id", "team"});
  if (const auto id = map.find("id")) robot.id = static_cast<int>(id->integer(0, 255));
  if (const auto team = map.find("team")) robot.team = team->choice(kTeams) == 0 ? Team::cyan : Team::magenta;
}

RobotFile robot_of(const Value& root, const fs::path& folder) {
  const Map map = root.map({"robot", "camera", "colors", "field", "start_pose", "plugins", "vision"});
  RobotFile robot;
  if (const auto value = map.find("robot")) read_identity(*value, robot);
  if (const auto value = map.find("camera")) robot.camera = value->path(folder);
  if (const auto value = map.find("colors")) robot.colors = value->path(folder);
  if (const auto value = map.find("field"))
    robot.field = is_field_path(value->string()) ? value->path(folder).string() : value->string();
  if (const auto value = map.find("start_pose")) robot.start_pose = start_pose_of(*value);
  if (const auto value = map.find("plugins"); value && !value->is_null())
    for (const Value& plugin : value->list()) robot.plugins.push_back(plugin.path(folder));
  if (const auto value = map.find("vision"); value && !value->is_null())  // all commented out is as good as missing
    for (const auto& [key, entry] : value->any_map().entries()) robot.vision.emplace_back(key, entry.setting());
  return robot;
}

}  // namespace

RobotFile read_robot(const fs::path& file) { return robot_of(read_yaml(file), file.parent_path()); }
RobotFile robot_from_yaml(std::string_view text, const fs::path& file) {
  return robot_of(parse_yaml(text, file.string()), file.parent_path());
}

}  // namespace tassilo
