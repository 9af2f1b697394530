#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tassilo/message/ros_messages.h"

// Tassilo's own messages, package tassilo_msgs, built like soccer_vision_3d_msgs: a header, then a list. What the
// fields mean is written in msg/*.msg, which are installed; a test holds both together. To add a message: 1. its .msg
// file; 2. its struct here; 3. its line in topics.h.

namespace tassilo::msgs {

struct Ball {
  static constexpr std::string_view kType = "tassilo_msgs/Ball";
  ros::Point center;
  std::array<double, 4> covariance{};
  double near = 0, far = 0;
  double confidence = 0;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("center", self.center);
    visit("covariance", self.covariance);
    visit("near", self.near);
    visit("far", self.far);
    visit("confidence", self.confidence);
  }
};

struct BallArray {
  static constexpr std::string_view kType = "tassilo_msgs/BallArray";
  ros::Header header;
  std::vector<Ball> balls;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("balls", self.balls);
  }
};

struct GoalPost {
  static constexpr std::string_view kType = "tassilo_msgs/GoalPost";
  static constexpr std::string_view kConstants = "uint8 LEFT=0\nuint8 RIGHT=1\n";
  std::uint8_t side = 0;
  ros::Point base;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("side", self.side);
    visit("base", self.base);
  }
};

struct Goal {
  static constexpr std::string_view kType = "tassilo_msgs/Goal";
  static constexpr std::string_view kConstants = "uint8 YELLOW=0\nuint8 BLUE=1\n";
  std::uint8_t color = 0;
  double bearing = 0;
  ros::Point center;
  std::vector<GoalPost> posts;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("color", self.color);
    visit("bearing", self.bearing);
    visit("center", self.center);
    visit("posts", self.posts);
  }
};

struct GoalArray {
  static constexpr std::string_view kType = "tassilo_msgs/GoalArray";
  ros::Header header;
  std::vector<Goal> goals;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("goals", self.goals);
  }
};

struct Robot {
  static constexpr std::string_view kType = "tassilo_msgs/Robot";
  static constexpr std::string_view kConstants = "uint8 UNKNOWN=0\nuint8 CYAN=1\nuint8 MAGENTA=2\n";
  std::uint8_t team = 0;
  ros::Point nearest;
  std::array<double, 4> covariance{};
  double near = 0, far = 0;
  ros::Point center;
  double width = 0;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("team", self.team);
    visit("nearest", self.nearest);
    visit("covariance", self.covariance);
    visit("near", self.near);
    visit("far", self.far);
    visit("center", self.center);
    visit("width", self.width);
  }
};

struct RobotArray {
  static constexpr std::string_view kType = "tassilo_msgs/RobotArray";
  ros::Header header;
  std::vector<Robot> robots;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("robots", self.robots);
  }
};

struct Line {
  static constexpr std::string_view kType = "tassilo_msgs/Line";
  static constexpr std::string_view kConstants = "uint8 LINE=0\nuint8 BOUNDARY=1\n";
  std::uint8_t kind = 0;
  ros::Point p, q;
  std::string model;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("kind", self.kind);
    visit("p", self.p);
    visit("q", self.q);
    visit("model", self.model);
  }
};

struct Circle {
  static constexpr std::string_view kType = "tassilo_msgs/Circle";
  ros::Point center;
  double radius = 0;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("center", self.center);
    visit("radius", self.radius);
  }
};

struct LineArray {
  static constexpr std::string_view kType = "tassilo_msgs/LineArray";
  ros::Header header;
  std::vector<Line> lines;
  std::vector<Circle> circles;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("lines", self.lines);
    visit("circles", self.circles);
  }
};

struct FreeSpace {
  static constexpr std::string_view kType = "tassilo_msgs/FreeSpace";
  static constexpr std::string_view kConstants = "uint8 UNSEEN=0\nuint8 FREE=1\nuint8 BLOCKED=2\n";
  ros::Header header;
  ros::Point origin;
  double angle_min = 0, angle_increment = 0;
  double range_max = 0;
  std::vector<float> ranges;
  std::vector<std::uint8_t> states;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("origin", self.origin);
    visit("angle_min", self.angle_min);
    visit("angle_increment", self.angle_increment);
    visit("range_max", self.range_max);
    visit("ranges", self.ranges);
    visit("states", self.states);
  }
};

struct Track {
  static constexpr std::string_view kType = "tassilo_msgs/Track";
  static constexpr std::string_view kConstants = "uint8 BALL=0\nuint8 ROBOT=1\n";
  std::int32_t id = 0;
  std::uint8_t kind = 0;
  std::uint8_t team = 0;
  ros::Point position;
  ros::Vector3 velocity;
  std::array<double, 16> covariance{};
  double age = 0;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("id", self.id);
    visit("kind", self.kind);
    visit("team", self.team);
    visit("position", self.position);
    visit("velocity", self.velocity);
    visit("covariance", self.covariance);
    visit("age", self.age);
  }
};

struct TrackArray {
  static constexpr std::string_view kType = "tassilo_msgs/TrackArray";
  ros::Header header;
  std::vector<Track> tracks;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("tracks", self.tracks);
  }
};

struct TeamState {
  static constexpr std::string_view kType = "tassilo_msgs/TeamState";
  static constexpr std::string_view kConstants =
      "uint8 NO_POSE=0\nuint8 TWO_LINES=1\nuint8 ONE_LINE=2\nuint8 PREDICTED=3\nuint8 GOAL=4\nuint8 MODEL=5\n"
      "uint8 START=6\n";
  ros::Header header;
  std::uint8_t robot = 0;
  std::uint8_t team = 0;
  std::string role, action, planning_state;
  std::uint8_t pose_kind = 0;
  double pose_age = 0;
  bool pose_is_mirrored = false;
  double frame_rate = 0;
  double latency = 0;
  std::uint64_t frames = 0;
  std::uint64_t messages = 0;
  std::uint64_t withheld = 0;
  double bytes_per_second = 0;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("robot", self.robot);
    visit("team", self.team);
    visit("role", self.role);
    visit("action", self.action);
    visit("planning_state", self.planning_state);
    visit("pose_kind", self.pose_kind);
    visit("pose_age", self.pose_age);
    visit("pose_is_mirrored", self.pose_is_mirrored);
    visit("frame_rate", self.frame_rate);
    visit("latency", self.latency);
    visit("frames", self.frames);
    visit("messages", self.messages);
    visit("withheld", self.withheld);
    visit("bytes_per_second", self.bytes_per_second);
  }
};

}  // namespace tassilo::msgs
