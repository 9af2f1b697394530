#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tassilo/camera/camera_model.h"
#include "tassilo/message/camera_info.h"
#include "tassilo/source/frame_source.h"
#include "tassilo/team/bus.h"
#include "tassilo/team/topic_images.h"
#include "tassilo/timeline/odometry.h"

namespace tassilo {

/// Room for images without compression: 1920 x 1080 pixels of RGB are 6 MB. [B]
inline constexpr int kMostImageBytes = 16 << 20;

/// Whether a location names a topic: begins with `topic:`.
bool is_topic(const std::string& location);
/// "/camera/image_raw" of `topic:/camera/image_raw`.
std::string topic_of(const std::string& location);

/// Which topics a run listens to; empty: none.
struct InputTopics {
  std::string images;
  std::string camera_info;  ///< Empty: that of `images`.
  std::string odometry;
  bool empty() const { return images.empty() && odometry.empty(); }
};

/// What comes from ROS 2 into a run: images, what their driver says of the lens, odometry. All on one bus.
///
/// threads  one at a time
class TopicInput {
 public:
  /// Throws Error when the bus cannot be had.
  TopicInput(const BusOptions& bus, InputTopics topics);
  TopicInput(const TopicInput&) = delete;
  TopicInput& operator=(const TopicInput&) = delete;

  /// Who wants to know what happens: a line for people, without its end.
  void set_news(std::function<void(const std::string&)> news) { news_ = std::move(news); }

  /// Waits for the first image, whoever publishes it and whenever; `options` say how RGB is read and when waiting is
  /// interrupted; `range`, when given, is that of YUV images. The source may not outlive this.
  FrameSource open_images(const SourceOptions& options, std::optional<ColorRange> range);

  /// Odometry that came since the last call, in the order in which it came.
  std::vector<OdometrySample> take_odometry();

  /// Compares the camera file with what the driver says of its lens, whenever either is new. Nothing without a camera
  /// file.
  /// Throws Error when what the driver says first is not the camera file's: size, or more than kMostLensDifference
  /// anywhere. Later differences are told: whoever reaches the bus can say so, and a robot at play goes on.
  void check_camera(const std::optional<CameraModel>& camera);

  /// For people, lines with their ends: what was missed or refused; empty when nothing was.
  std::string summary() const;

 private:
  class Reader;
  std::optional<Frame> next_image(const std::function<bool()>& interrupted);
  void pump();
  void listen_to_camera_info();
  void listen_to_odometry();
  void add(const BusSample& odometry);
  void tell(const std::string& line) const;

  Bus bus_;
  InputTopics topics_;
  std::function<void(const std::string&)> news_;
  std::optional<TopicImages> images_;
  std::optional<BusReader> camera_info_, odometry_;
  std::optional<ToldLens> lens_;            ///< What the driver said last.
  std::optional<double> first_image_at_;    ///< On the steady clock. [s]
  std::optional<CameraModel> compared_to_;  ///< The camera file that was compared last.
  std::optional<ToldLens> compared_;        ///< With this.
  bool has_agreed_ = false, has_told_no_info_ = false;
  std::int64_t refused_infos_ = 0;
  std::string first_info_refusal_;
  double began_at_ = 0;  ///< On the steady clock. [s]
  bool has_told_no_odometry_ = false;
  std::vector<OdometrySample> samples_;
  std::int64_t odometry_came_ = 0, odometry_refused_ = 0, odometry_dropped_ = 0;
  std::string first_odometry_refusal_;
};

}  // namespace tassilo
