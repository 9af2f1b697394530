#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// The messages of ROS 2 that are spoken here, field by field as in its .msg files (common_interfaces, Humble to Jazzy),
// which say what they mean. Lower floors have types of their own; these are for the outside.
//
// Images are large: borrowed ones are read without a copy, and live no longer than the bytes they were read from.

namespace tassilo::ros {

struct Time {
  static constexpr std::string_view kType = "builtin_interfaces/Time";
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;  ///< < 10^9
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("sec", self.sec);
    visit("nanosec", self.nanosec);
  }
};

struct Header {
  static constexpr std::string_view kType = "std_msgs/Header";
  Time stamp;
  std::string frame_id;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("stamp", self.stamp);
    visit("frame_id", self.frame_id);
  }
};

struct Point {
  static constexpr std::string_view kType = "geometry_msgs/Point";
  double x = 0, y = 0, z = 0;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("x", self.x);
    visit("y", self.y);
    visit("z", self.z);
  }
};

struct Vector3 {
  static constexpr std::string_view kType = "geometry_msgs/Vector3";
  double x = 0, y = 0, z = 0;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("x", self.x);
    visit("y", self.y);
    visit("z", self.z);
  }
};

struct Quaternion {
  static constexpr std::string_view kType = "geometry_msgs/Quaternion";
  double x = 0, y = 0, z = 0, w = 1;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("x", self.x);
    visit("y", self.y);
    visit("z", self.z);
    visit("w", self.w);
  }
};

struct Pose {
  static constexpr std::string_view kType = "geometry_msgs/Pose";
  Point position;
  Quaternion orientation;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("position", self.position);
    visit("orientation", self.orientation);
  }
};

struct PoseWithCovariance {
  static constexpr std::string_view kType = "geometry_msgs/PoseWithCovariance";
  Pose pose;
  std::array<double, 36> covariance{};  ///< Row-major x, y, z, rotation about X, Y, Z.
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("pose", self.pose);
    visit("covariance", self.covariance);
  }
};

struct PoseWithCovarianceStamped {
  static constexpr std::string_view kType = "geometry_msgs/PoseWithCovarianceStamped";
  Header header;
  PoseWithCovariance pose;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("pose", self.pose);
  }
};

struct Twist {
  static constexpr std::string_view kType = "geometry_msgs/Twist";
  Vector3 linear, angular;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("linear", self.linear);
    visit("angular", self.angular);
  }
};

struct TwistWithCovariance {
  static constexpr std::string_view kType = "geometry_msgs/TwistWithCovariance";
  Twist twist;
  std::array<double, 36> covariance{};
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("twist", self.twist);
    visit("covariance", self.covariance);
  }
};

struct Odometry {
  static constexpr std::string_view kType = "nav_msgs/Odometry";
  Header header;
  std::string child_frame_id;
  PoseWithCovariance pose;
  TwistWithCovariance twist;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("child_frame_id", self.child_frame_id);
    visit("pose", self.pose);
    visit("twist", self.twist);
  }
};

struct Transform {
  static constexpr std::string_view kType = "geometry_msgs/Transform";
  Vector3 translation;
  Quaternion rotation;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("translation", self.translation);
    visit("rotation", self.rotation);
  }
};

struct TransformStamped {
  static constexpr std::string_view kType = "geometry_msgs/TransformStamped";
  Header header;
  std::string child_frame_id;
  Transform transform;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("child_frame_id", self.child_frame_id);
    visit("transform", self.transform);
  }
};

struct TFMessage {
  static constexpr std::string_view kType = "tf2_msgs/TFMessage";
  std::vector<TransformStamped> transforms;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("transforms", self.transforms);
  }
};

struct LaserScan {
  static constexpr std::string_view kType = "sensor_msgs/LaserScan";
  Header header;
  float angle_min = 0, angle_max = 0, angle_increment = 0;  ///< [rad]
  float time_increment = 0, scan_time = 0;                  ///< [s]
  float range_min = 0, range_max = 0;                       ///< [m]
  std::vector<float> ranges;                                ///< [m]
  std::vector<float> intensities;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("angle_min", self.angle_min);
    visit("angle_max", self.angle_max);
    visit("angle_increment", self.angle_increment);
    visit("time_increment", self.time_increment);
    visit("scan_time", self.scan_time);
    visit("range_min", self.range_min);
    visit("range_max", self.range_max);
    visit("ranges", self.ranges);
    visit("intensities", self.intensities);
  }
};

/// `Bytes` holds the file, or is a borrowed look at it.
template <class Bytes>
struct BasicCompressedImage {
  static constexpr std::string_view kType = "sensor_msgs/CompressedImage";
  Header header;
  std::string format;  ///< "jpeg", "png"; more may follow after a ";".
  Bytes data;          ///< The file.
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("format", self.format);
    visit("data", self.data);
  }
};
using CompressedImage = BasicCompressedImage<std::vector<std::uint8_t>>;
using BorrowedCompressedImage = BasicCompressedImage<std::span<const std::uint8_t>>;

/// `Bytes` holds the pixels, or is a borrowed look at them.
template <class Bytes>
struct BasicImage {
  static constexpr std::string_view kType = "sensor_msgs/Image";
  Header header;
  std::uint32_t height = 0, width = 0;  ///< [px]
  std::string encoding;
  std::uint8_t is_bigendian = 0;
  std::uint32_t step = 0;  ///< From row to row. [B]
  Bytes data;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("height", self.height);
    visit("width", self.width);
    visit("encoding", self.encoding);
    visit("is_bigendian", self.is_bigendian);
    visit("step", self.step);
    visit("data", self.data);
  }
};
using Image = BasicImage<std::vector<std::uint8_t>>;
using BorrowedImage = BasicImage<std::span<const std::uint8_t>>;

struct RegionOfInterest {
  static constexpr std::string_view kType = "sensor_msgs/RegionOfInterest";
  std::uint32_t x_offset = 0, y_offset = 0, height = 0, width = 0;  ///< [px]
  bool do_rectify = false;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("x_offset", self.x_offset);
    visit("y_offset", self.y_offset);
    visit("height", self.height);
    visit("width", self.width);
    visit("do_rectify", self.do_rectify);
  }
};

struct CameraInfo {
  static constexpr std::string_view kType = "sensor_msgs/CameraInfo";
  Header header;
  std::uint32_t height = 0, width = 0;  ///< [px]
  std::string distortion_model;
  std::vector<double> d;
  std::array<double, 9> k{}, r{};
  std::array<double, 12> p{};
  std::uint32_t binning_x = 0, binning_y = 0;
  RegionOfInterest roi;
  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("header", self.header);
    visit("height", self.height);
    visit("width", self.width);
    visit("distortion_model", self.distortion_model);
    visit("d", self.d);
    visit("k", self.k);
    visit("r", self.r);
    visit("p", self.p);
    visit("binning_x", self.binning_x);
    visit("binning_y", self.binning_y);
    visit("roi", self.roi);
  }
};

}  // namespace tassilo::ros
