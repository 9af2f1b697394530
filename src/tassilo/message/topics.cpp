#include "tassilo/message/topics.h"

#include <algorithm>
#include <charconv>

namespace tassilo {
namespace {

constexpr std::string_view kPrefix = "/robot";
constexpr int kLargestRobot = 255;

const Topic* topic_named(std::string_view name) {
  const auto* const found = std::ranges::find(kTopics, name, &Topic::name);
  return found == kTopics.end() ? nullptr : found;
}

}  // namespace

std::string ros_topic_name(const Topic& topic, int robot) {
  std::string name(topic.name == kTransformsTopic.name ? "" : kPrefix);
  if (!name.empty()) name.append(std::to_string(robot));
  return name.append("/").append(topic.name);
}

RobotTopic robot_topic_from(std::string_view ros_name) {
  if (ros_name == "/tf") return {topic_named(kTransformsTopic.name), -1};
  if (!ros_name.starts_with(kPrefix)) return {};
  const std::string_view rest = ros_name.substr(kPrefix.size());
  int robot = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), robot);
  if (error != std::errc{} || robot < 0 || robot > kLargestRobot) return {};
  const std::string_view number(rest.data(), end);
  const std::string_view behind = rest.substr(number.size());
  // One name for a robot: neither "robot03" nor "robot-0".
  if (number != std::to_string(robot) || !behind.starts_with('/')) return {};
  const Topic* const topic = topic_named(behind.substr(1));
  if (topic == nullptr || topic->name == kTransformsTopic.name) return {};
  return {topic, robot};
}

}  // namespace tassilo
