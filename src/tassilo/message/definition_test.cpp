#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tassilo/message/topics.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

/// Without comments, empty lines and more than one space in a row.
std::string stripped(std::istream& in) {
  std::string text, line;
  while (std::getline(in, line)) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string word, kept;
    while (words >> word) kept += (kept.empty() ? "" : " ") + word;
    if (!kept.empty()) text += kept + "\n";
  }
  return text;
}

/// Type -> definition, of all our topics.
std::map<std::string, std::string> told() {
  std::map<std::string, std::string> definitions;
  for (const Topic& topic : kTopics) {
    std::string type = topic.ros_type();
    type.erase(type.find("/msg"), 4);
    std::istringstream text("MSG: " + type + "\n" + topic.definition());
    std::string line;
    while (std::getline(text, line)) {
      if (line.starts_with("MSG: "))
        definitions[type = line.substr(5)].clear();
      else if (line.find("====") == std::string::npos)
        definitions[type] += line + "\n";
    }
  }
  return definitions;
}

TEST(Definition, IsThatOfTheInstalledFiles) {
  const auto definitions = told();
  int count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(TASSILO_SOURCE_DIR) / "ros2/tassilo_msgs/msg")) {
    std::ifstream file(entry.path());
    const auto found = definitions.find("tassilo_msgs/" + entry.path().stem().string());
    ASSERT_NE(found, definitions.end()) << entry.path() << " belongs to no topic";
    EXPECT_EQ(found->second, stripped(file)) << entry.path();
    ++count;
  }
  EXPECT_EQ(count,
            std::ranges::count_if(definitions, [](const auto& d) { return d.first.starts_with("tassilo_msgs/"); }));
}

TEST(Definition, OfAStandardTypeIsAsRosHasIt) {
  // common_interfaces: sensor_msgs/msg/CompressedImage.msg, without comments.
  EXPECT_EQ(definition<ros::CompressedImage>(),
            "std_msgs/Header header\nstring format\nuint8[] data\n" + std::string(80, '=') +
                "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + std::string(80, '=') +
                "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n");
}

TEST(TypeNames, AreThoseOfRos) {
  EXPECT_EQ(ros_type_name<ros::LaserScan>(), "sensor_msgs/msg/LaserScan");
  EXPECT_EQ(wire_type_name<ros::LaserScan>(), "sensor_msgs::msg::dds_::LaserScan_");
}

}  // namespace
}  // namespace tassilo
