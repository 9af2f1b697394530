// A camera driver of ROS 2, for tests: publishes a recording as topics in real time, and a robot's odometry with it.
// Stamps are those of the recording after `base`, a whole second of UNIX time.
//
// usage: topic_publisher DOMAIN SOURCE ENCODING [OPTION=VALUE]...
//   ENCODING        yuv422, yuyv, nv12 (of 4:2:0 videos), or for folders of images rgb8, bgr8 (PNG), file (their bytes,
//                   as CompressedImage); bayer_rggb8 (grey bytes), wrong_type (odometry in place of images)
//   topic=NAME      of the images, else /camera/image_raw
//   camera=FILE     CameraInfo of this camera file with each image
//   odometry=FILE   odometry.jsonl at /odom
//   rate=FPS        instead of the recording's own pace
//   frames=N        no more than so many
//   pause=K:S       nothing for S seconds before frame K
//   malformed=K     messages that are none before frame K: cut, too small a step, another size, a bad stamp; an
//                   odometry that is none; CameraInfo that is none
//   older=K         frame K - 1 is sent again before frame K
//   back=K          from frame K on stamps are those of an hour before
// Prints "ready", "base SECONDS" once its topics are heard, "done" at the end; ends with standard input.
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/odometry_file.h"
#include "tassilo/files/png.h"
#include "tassilo/message/camera_info.h"
#include "tassilo/message/codec.h"
#include "tassilo/message/from_scene.h"
#include "tassilo/source/frame_source.h"
#include "tassilo/team/bus.h"
#include "tassilo/team/topic_images.h"

namespace tassilo {
namespace {

using Clock = std::chrono::steady_clock;
using Bytes = std::vector<std::uint8_t>;

ros::Image image_of(const FrameView& view, const std::string& encoding) {
  ros::Image image;
  image.width = static_cast<std::uint32_t>(view.width());
  image.height = static_cast<std::uint32_t>(view.height());
  image.encoding = encoding;
  image.step = static_cast<std::uint32_t>((view.width() + 1) / 2 * 4);
  if (encoding == "nv12") image.step /= 2;
  for (int r = 0; r < view.height(); ++r) {
    const std::size_t begin = image.data.size();
    for (int c = 0; c < view.width(); c += 2) {
      const std::uint8_t y = view.y(c, r), next = c + 1 < view.width() ? view.y(c + 1, r) : std::uint8_t{0};
      if (encoding == "yuv422")
        image.data.insert(image.data.end(), {view.u(c, r), y, view.v(c, r), next});
      else if (encoding == "yuyv")
        image.data.insert(image.data.end(), {y, view.u(c, r), next, view.v(c, r)});
      else
        image.data.insert(image.data.end(), {y, next});
    }
    image.data.resize(begin + image.step);
  }
  if (encoding == "nv12")
    for (int r = 0; r < view.height(); r += 2)
      for (int c = 0; c < view.width(); c += 2) image.data.insert(image.data.end(), {view.u(c, r), view.v(c, r)});
  return image;
}

ros::Image image_of(const RgbImage& picture, const std::string& encoding) {
  ros::Image image;
  image.width = static_cast<std::uint32_t>(picture.width);
  image.height = static_cast<std::uint32_t>(picture.height);
  image.encoding = encoding;
  image.step = 3 * image.width;
  image.data = picture.pixels;
  if (encoding == "bgr8")
    for (std::size_t i = 0; i + 2 < image.data.size(); i += 3) std::swap(image.data[i], image.data[i + 2]);
  return image;
}

Bytes bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The division model is not ROS's. Its closed form is the generating function of Catalan's numbers, of whose continued
/// fraction a rational polynomial is the sixth convergent: the same to a thousandth of a pixel.
ros::CameraInfo camera_info_of(const CameraModel& camera) {
  ros::CameraInfo info;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.k = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.p = {camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0};
  if (const auto* division = std::get_if<Division>(&camera.distortion)) {
    const double k = division->k;
    info.distortion_model = "rational_polynomial";
    info.d = {-5 * k, 6 * k * k, 0, 0, -k * k * k, -6 * k, 10 * k * k, -4 * k * k * k};
  } else if (const auto* plumb = std::get_if<PlumbBob>(&camera.distortion)) {
    info.distortion_model = "plumb_bob";
    info.d = {plumb->k1, plumb->k2, plumb->p1, plumb->p2, plumb->k3};
  } else {
    throw Error("camera", "must be division or plumb_bob here");
  }
  return info;
}

struct Arguments {
  int domain = 0;
  std::string source, encoding;
  std::map<std::string, std::string> options;

  std::string option(const std::string& name, const std::string& otherwise = "") const {
    const auto found = options.find(name);
    return found != options.end() ? found->second : otherwise;
  }
  int number(const std::string& name) const { return std::stoi(option(name, "-1")); }
};

class Publisher {
 public:
  explicit Publisher(Arguments arguments)
      : arguments_(std::move(arguments)), is_file_(arguments_.encoding == "file"), bus_([&] {
          BusOptions options;
          options.domain = arguments_.domain;
          options.max_bytes = 16 << 20;
          return options;
        }()) {
    const std::string topic = arguments_.option("topic", "/camera/image_raw");
    std::string type = is_file_ ? wire_type_name<ros::CompressedImage>() : wire_type_name<ros::Image>();
    if (arguments_.encoding == "wrong_type") type = wire_type_name<ros::Odometry>();
    images_.emplace(writer(topic, type));
    if (!arguments_.option("camera").empty()) {
      info_ = camera_info_of(read_camera(arguments_.option("camera")).model);
      infos_.emplace(writer(camera_info_topic_of(topic), wire_type_name<ros::CameraInfo>()));
    }
    if (!arguments_.option("odometry").empty()) {
      lines_ = read_odometry_lines(arguments_.option("odometry"));
      odometry_.emplace(writer("/odom", wire_type_name<ros::Odometry>()));
    }
  }

  void operator()() {
    std::cout << "ready" << std::endl;
    wait_for_readers();
    SourceOptions options;
    options.location = arguments_.source;
    FrameSource source = open_source(options);
    using std::chrono::system_clock;
    const auto second = std::chrono::ceil<std::chrono::seconds>(system_clock::now());
    std::this_thread::sleep_until(second);
    const auto begin = Clock::now();
    base_ = second.time_since_epoch().count();
    std::cout << "base " << base_ << std::endl;
    const std::string pause = arguments_.option("pause", "-1:0");
    double paused = 0;
    const int most = arguments_.number("frames");
    for (int k = 0; most < 0 || k < most; ++k) {
      const auto frame = source.next();
      if (!frame) break;
      if (std::stoi(pause) == k) paused = std::stod(pause.substr(pause.find(':') + 1));
      const double rate = std::stod(arguments_.option("rate", "0"));
      const double due = (rate > 0 ? k / rate : frame->t) + paused;
      std::this_thread::sleep_until(begin +
                                    std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(due)));
      if (arguments_.number("malformed") == k) send_malformed();
      if (arguments_.number("older") == k) send_and_wait(*images_, last_);
      send_odometry_until(frame->t + 0.06);
      if (arguments_.number("back") == k) base_ -= 3600;
      if (info_) {
        info_->header = header_at(frame->t);
        infos_->write(encoded(*info_));
      }
      last_ = message_of(*frame);
      images_->write(last_);
    }
    std::cout << "done" << std::endl;
  }

 private:
  BusWriter writer(const std::string& name, const std::string& type) {
    BusTopic topic;
    topic.name = wire_topic_name(name);
    topic.type = type;
    topic.depth = 10;
    topic.reliability = BusReliability::reliable;  // as most drivers do
    return bus_.writer(topic);
  }
  void wait_for_readers() {
    const auto end = Clock::now() + std::chrono::seconds(20);
    while (
        (images_->readers() == 0 || (infos_ && infos_->readers() == 0) || (odometry_ && odometry_->readers() == 0)) &&
        Clock::now() < end)
      bus_.wait(std::chrono::milliseconds(20));
  }
  ros::Header header_at(double t) const {
    ros::Header header{ros_time(t), "camera"};
    header.stamp.sec += static_cast<std::int32_t>(base_);
    return header;
  }
  ros::Image grey(const FrameView& view) const {
    ros::Image image;
    image.width = image.step = static_cast<std::uint32_t>(view.width());
    image.height = static_cast<std::uint32_t>(view.height());
    image.encoding = arguments_.encoding;
    image.data.resize(std::size_t{image.step} * image.height, 128);
    return image;
  }
  std::vector<std::byte> message_of(const Frame& frame) {
    const std::filesystem::path file = std::filesystem::path(arguments_.source) / frame.image;
    if (is_file_) {
      const bool is_png = file.extension() == ".png";
      return encoded(
          ros::CompressedImage{header_at(frame.t), is_png ? "png" : "bgr8; jpeg compressed bgr8", bytes_of(file)});
    }
    if (arguments_.encoding == "wrong_type") return encoded(ros::Odometry{});
    const bool is_rgb = arguments_.encoding == "rgb8" || arguments_.encoding == "bgr8";
    ros::Image image = arguments_.encoding.starts_with("bayer") ? grey(frame.view)
                       : is_rgb                                 ? image_of(read_png_rgb(file), arguments_.encoding)
                                                                : image_of(frame.view, arguments_.encoding);
    image.header = header_at(frame.t);
    newest_image_ = image;
    return encoded(image);
  }
  void send_odometry_until(double t) {
    for (; odometry_ && next_line_ < lines_.size() && lines_[next_line_].sample.t <= t; ++next_line_) {
      const OdometrySample& sample = lines_[next_line_].sample;
      ros::Odometry message;
      message.header = header_at(sample.t);
      message.header.frame_id = "odom";
      message.child_frame_id = "base_footprint";
      message.pose.pose = {{sample.x, sample.y, 0}, quaternion_of(sample.theta)};
      odometry_->write(encoded(message));
    }
  }
  /// So that it is looked at by itself, and not replaced by a newer one.
  static void send_and_wait(BusWriter& writer, const std::vector<std::byte>& message) {
    writer.write(message);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
  }
  void send_malformed() {
    std::vector<std::byte> cut = last_;
    cut.resize(cut.size() / 2);
    send_and_wait(*images_, cut);
    if (newest_image_) {
      ros::Image image = *newest_image_;
      image.step = 1;
      send_and_wait(*images_, encoded(image));
      image = *newest_image_;
      image.height /= 2;
      image.data.resize(std::size_t{image.step} * image.height);
      send_and_wait(*images_, encoded(image));
      image = *newest_image_;
      image.header.stamp.nanosec = 4'000'000'000;
      send_and_wait(*images_, encoded(image));
      image = *newest_image_;
      image.encoding = "mono8\33[2J";
      send_and_wait(*images_, encoded(image));
    }
    if (odometry_) {
      ros::Odometry message;
      message.pose.pose.orientation.w = 0;
      odometry_->write(encoded(message));
    }
    if (infos_) {
      ros::CameraInfo info = *info_;
      info.distortion_model = "mirror";
      send_and_wait(*infos_, encoded(info));
    }
  }

  Arguments arguments_;
  bool is_file_;
  Bus bus_;
  std::optional<BusWriter> images_, infos_, odometry_;
  std::optional<ros::CameraInfo> info_;
  std::vector<OdometryLine> lines_;
  std::size_t next_line_ = 0;
  std::int64_t base_ = 0;
  std::vector<std::byte> last_;
  std::optional<ros::Image> newest_image_;
};

}  // namespace
}  // namespace tassilo

int main(int count, char** words) {
  if (count < 4) {
    std::cerr << "usage: topic_publisher DOMAIN SOURCE ENCODING [OPTION=VALUE]...\n";
    return 2;
  }
  try {
    tassilo::Arguments arguments{std::stoi(words[1]), words[2], words[3], {}};
    for (int i = 4; i < count; ++i) {
      const std::string word = words[i];
      arguments.options[word.substr(0, word.find('='))] = word.substr(word.find('=') + 1);
    }
    tassilo::Publisher publisher(arguments);
    publisher();
    std::cin.get();
  } catch (const std::exception& error) {
    std::cerr << "topic_publisher: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
