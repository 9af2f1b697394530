#pragma once

#include <array>
#include <string>
#include <string_view>

#include "tassilo/message/codec.h"
#include "tassilo/message/ros_messages.h"
#include "tassilo/message/tassilo_messages.h"

// What a robot tells, and under which names. docs/ros2.md.

namespace tassilo {

/// One topic of a robot: its name behind "robot<id>/", and its type.
struct Topic {
  std::string_view name;
  std::string (*ros_type)();    ///< "sensor_msgs/msg/LaserScan"
  std::string (*wire_type)();   ///< "sensor_msgs::msg::dds_::LaserScan_"
  std::string (*definition)();  ///< Of the type and all it uses.
};

template <Message M>
constexpr Topic topic_of(std::string_view name) {
  return {name, ros_type_name<M>, wire_type_name<M>, definition<M>};
}

inline constexpr Topic kPoseTopic = topic_of<ros::PoseWithCovarianceStamped>("pose");
inline constexpr Topic kOdometryTopic = topic_of<ros::Odometry>("odom");
inline constexpr Topic kScanTopic = topic_of<ros::LaserScan>("scan");
inline constexpr Topic kFreeSpaceTopic = topic_of<msgs::FreeSpace>("free_space");
inline constexpr Topic kBallsTopic = topic_of<msgs::BallArray>("balls");
inline constexpr Topic kRobotsTopic = topic_of<msgs::RobotArray>("robots");
inline constexpr Topic kGoalsTopic = topic_of<msgs::GoalArray>("goals");
inline constexpr Topic kLinesTopic = topic_of<msgs::LineArray>("lines");
inline constexpr Topic kTracksTopic = topic_of<msgs::TrackArray>("tracks");
inline constexpr Topic kTeamStateTopic = topic_of<msgs::TeamState>("team_state");
inline constexpr Topic kImageTopic = topic_of<ros::CompressedImage>("image/compressed");
/// Of all robots together, as tf2 expects it: "tf" alone.
inline constexpr Topic kTransformsTopic = topic_of<ros::TFMessage>("tf");

inline constexpr std::array kTopics{kPoseTopic,   kOdometryTopic,  kScanTopic,  kFreeSpaceTopic,
                                    kBallsTopic,  kRobotsTopic,    kGoalsTopic, kLinesTopic,
                                    kTracksTopic, kTeamStateTopic, kImageTopic, kTransformsTopic};

/// "/robot3/pose", and "/tf" for all.
std::string ros_topic_name(const Topic& topic, int robot);
/// The topic and the robot of such a name; null and -1 for another. Robots: 0..255.
struct RobotTopic {
  const Topic* topic = nullptr;
  int robot = -1;  ///< -1 for "/tf", too.
};
RobotTopic robot_topic_from(std::string_view ros_name);

}  // namespace tassilo
