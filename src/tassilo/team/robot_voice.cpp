#include "tassilo/team/robot_voice.h"

#include "tassilo/base/contract.h"

namespace tassilo {

bool is_counted(const Topic& topic) {
  return topic.name != kImageTopic.name && topic.name != kScanTopic.name && topic.name != kTransformsTopic.name;
}

RobotVoice::RobotVoice(Bus& bus, int robot, const BudgetOptions& budget, BusReliability reliability) : budget_(budget) {
  for (const Topic& topic : kTopics)
    writers_.emplace(topic.name, bus.writer({wire_topic_name(ros_topic_name(topic, robot)), topic.wire_type(),
                                             reliability, /*depth=*/1}));
}

bool RobotVoice::send(const Topic& topic, std::span<const std::byte> data, double now) {
  if (!budget_.allows(topic, data.size(), now)) return false;
  const auto writer = writers_.find(topic.name);
  expects(writer != writers_.end(), "a robot says what is in kTopics");
  writer->second.write(data);
  return true;
}

msgs::TeamState RobotVoice::say(std::span<const Spoken> messages, msgs::TeamState state, double now) {
  for (const Spoken& message : messages) {
    if (!send(*message.topic, message.data, now)) continue;
    ++sent_;
    counted_ += is_counted(*message.topic) ? 1 : 0;
  }
  state.messages = counted_;
  state.withheld = budget_.withheld();
  state.bytes_per_second = budget_.bytes_per_second(now);
  if (send(kTeamStateTopic, encoded(state), now)) {
    ++sent_;
    ++counted_;
  }
  return state;
}

bool RobotVoice::is_picture_wanted(double now) const {
  const auto writer = writers_.find(kImageTopic.name);
  return budget_.is_picture_due(now) && writer->second.readers() > 0;
}

void RobotVoice::show(const ros::CompressedImage& picture, double now) { send(kImageTopic, encoded(picture), now); }

}  // namespace tassilo
