#include "tassilo/files/robot_file.h"

#include <array>
#include <charconv>
#include <numbers>
#include <sstream>

#include "tassilo/files/field_file.h"
#include "tassilo/files/internal/exact_number.h"
#include "tassilo/files/internal/yaml_text.h"
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

bool is_number(const Setting& setting) {
  double value = 0;
  const char* const end = setting.text.data() + setting.text.size();
  const auto [rest, error] = std::from_chars(setting.text.data(), end, value);
  return error == std::errc() && rest == end;
}

void read_identity(const Value& value, RobotFile& robot) {
  constexpr std::array<std::string_view, 2> kTeams{"cyan", "magenta"};
  const Map map = value.map({"id", "team"});
  if (const auto id = map.find("id")) robot.id = static_cast<int>(id->integer(0, 255));
  if (const auto team = map.find("team")) robot.team = team->choice(kTeams) == 0 ? Team::cyan : Team::magenta;
}

BusSettings bus_of(const Value& value) {
  const Map map =
      value.map({"domain", "interface", "peers", "multicast", "reliable", "bytes_per_second", "picture_rate", "rates"});
  BusSettings bus;
  if (const auto domain = map.find("domain")) bus.domain = static_cast<int>(domain->integer(0, 232));
  if (const auto interface = map.find("interface")) bus.interface = interface->string();
  if (const auto peers = map.find("peers"))
    for (const Value& peer : peers->list()) bus.peers.push_back(peer.string());
  if (const auto multicast = map.find("multicast")) bus.multicast = multicast->boolean();
  if (const auto reliable = map.find("reliable")) bus.reliable = reliable->boolean();
  if (const auto bytes = map.find("bytes_per_second")) bus.bytes_per_second = bytes->number(1000, 1e9);
  if (const auto rate = map.find("picture_rate")) bus.picture_rate = rate->number(0, 100);
  if (const auto rates = map.find("rates"))
    for (const auto& [topic, rate] : rates->any_map().entries()) bus.rates.emplace(topic, rate.number(0.01, 1000));
  return bus;
}

std::string bus_yaml(const BusSettings& bus) {
  std::ostringstream out;
  out << "bus:\n";
  if (bus.domain) out << "  domain: " << *bus.domain << "\n";
  if (bus.interface) out << "  interface: " << yaml_text(*bus.interface) << "\n";
  if (!bus.peers.empty()) out << "  peers:\n";
  for (const std::string& peer : bus.peers) out << "    - " << yaml_text(peer) << "\n";
  if (bus.multicast) out << "  multicast: true\n";
  if (bus.reliable) out << "  reliable: true\n";
  if (bus.bytes_per_second) out << "  bytes_per_second: " << exact_number(*bus.bytes_per_second) << "\n";
  if (bus.picture_rate) out << "  picture_rate: " << exact_number(*bus.picture_rate) << "\n";
  if (!bus.rates.empty()) out << "  rates:\n";
  for (const auto& [topic, rate] : bus.rates) out << "    " << yaml_text(topic) << ": " << exact_number(rate) << "\n";
  return out.str();
}

RobotFile robot_of(const Value& root, const fs::path& folder) {
  const Map map =
      root.map({"robot", "camera", "colors", "field", "start_pose", "start_state", "bus", "plugins", "vision"});
  RobotFile robot;
  if (const auto value = map.find("robot")) read_identity(*value, robot);
  if (const auto value = map.find("camera")) robot.camera = value->path(folder);
  if (const auto value = map.find("colors")) robot.colors = value->path(folder);
  if (const auto value = map.find("field"))
    robot.field = is_field_path(value->string()) ? value->path(folder).string() : value->string();
  if (const auto value = map.find("start_pose")) robot.start_pose = start_pose_of(*value);
  if (const auto value = map.find("start_state")) robot.start_state = value->path(folder);
  if (const auto value = map.find("bus"); value && !value->is_null()) robot.bus = bus_of(*value);
  if (const auto value = map.find("plugins"); value && !value->is_null())
    for (const Value& plugin : value->list()) robot.plugins.push_back(plugin.path(folder));
  if (const auto value = map.find("vision"); value && !value->is_null())  // all commented out is as good as missing
    for (const auto& [key, entry] : value->any_map().entries()) robot.vision.emplace_back(key, entry.setting());
  return robot;
}

/// As it was written: a number stays one, whatever else it says stays text.
std::string setting_yaml(const Setting& setting) {
  const bool is_plain = !setting.quoted && (setting.text == "true" || setting.text == "false" || is_number(setting));
  return is_plain ? setting.text : yaml_text(setting.text);
}

}  // namespace

std::string robot_yaml(const RobotFile& robot, const fs::path& folder) {
  std::ostringstream out;
  out << "robot: {id: " << robot.id;
  if (robot.team != Team::unknown) out << ", team: " << to_string(robot.team);
  out << "}\n";
  if (robot.camera) out << "camera: " << yaml_path(*robot.camera, folder) << "\n";
  if (robot.colors) out << "colors: " << yaml_path(*robot.colors, folder) << "\n";
  if (robot.field) {
    const bool is_path = is_field_path(*robot.field);
    out << "field: " << (is_path ? yaml_path(*robot.field, folder) : yaml_text(*robot.field)) << "\n";
  }
  if (const auto& pose = robot.start_pose)
    out << "start_pose: {x: " << exact_number(pose->x) << ", y: " << exact_number(pose->y)
        << ", theta: " << exact_number(pose->theta) << ", sigma_xy: " << exact_number(pose->sigma_xy)
        << ", sigma_theta: " << exact_number(pose->sigma_theta) << "}\n";
  if (robot.start_state) out << "start_state: " << yaml_path(*robot.start_state, folder) << "\n";
  if (robot.bus != BusSettings{}) out << bus_yaml(robot.bus);
  if (!robot.plugins.empty()) {
    out << "plugins:\n";
    for (const fs::path& plugin : robot.plugins) out << "  - " << yaml_path(plugin, folder) << "\n";
  }
  if (!robot.vision.empty()) {
    out << "vision:\n";
    for (const auto& [key, setting] : robot.vision)
      out << "  " << yaml_text(key) << ": " << setting_yaml(setting) << "\n";
  }
  return out.str();
}

RobotFile read_robot(const fs::path& file) { return robot_of(read_yaml(file), file.parent_path()); }
RobotFile robot_from_yaml(std::string_view text, const fs::path& file) {
  return robot_of(parse_yaml(text, file.string()), file.parent_path());
}

}  // namespace tassilo
