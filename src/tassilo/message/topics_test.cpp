#include "tassilo/message/topics.h"

#include <gtest/gtest.h>

namespace tassilo {
namespace {

TEST(RobotTopic, NameGoesForthAndBack) {
  for (const Topic& topic : kTopics)
    for (const int robot : {0, 7, 10, 255}) {
      const RobotTopic back = robot_topic_from(ros_topic_name(topic, robot));
      ASSERT_NE(back.topic, nullptr) << topic.name;
      EXPECT_EQ(back.topic->name, topic.name);
      EXPECT_EQ(back.robot, topic.name == "tf" ? -1 : robot);
    }
}

TEST(RobotTopic, OneNameForOneRobot) {
  for (const char* name : {"", "/", "/robot/pose", "/robot-1/pose", "/robot01/pose", "/robot256/pose", "/robot3",
                           "/robot3/", "/robot3/poses", "/robot3/tf", "robot3/pose", "/robot3/pose/",
                           "/robot99999999999/pose", "/robot 3/pose", "/robot+3/pose"}) {
    EXPECT_EQ(robot_topic_from(name).topic, nullptr) << name;
    EXPECT_EQ(robot_topic_from(name).robot, -1) << name;
  }
}

}  // namespace
}  // namespace tassilo
