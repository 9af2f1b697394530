// Prints the definition of every message as logs carry them: its type, the text, and a line "%%".
#include <cstdio>
#include <string>

#include "tassilo/message/topics.h"

int main() {
  using namespace tassilo;
  const auto print = [](const Topic& topic) {
    std::printf("%s\n%s%%%%\n", topic.ros_type().c_str(), topic.definition().c_str());
  };
  for (const Topic& topic : kTopics) print(topic);
  // What only comes in.
  print(topic_of<ros::Image>("image_raw"));
  print(topic_of<ros::CameraInfo>("camera_info"));
  return 0;
}
