#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tassilo/image/frame.h"
#include "tassilo/message/image_frame.h"
#include "tassilo/team/bus.h"

namespace tassilo {

/// Whether this can be a topic's whole name: "/camera/image_raw", of letters, digits and underscores, no digit first in
/// a part.
bool is_ros_topic_name(std::string_view name);
/// The types under which a topic is published now, as on the wire, each once; also by this bus.
std::vector<std::string> published_types(const Bus& bus, std::string_view ros_name);
/// What a reader of this topic can ask for so that every publisher of that type is heard.
BusReliability offered_by_all(const Bus& bus, std::string_view ros_name, std::string_view wire_type);
/// "sensor_msgs/msg/Image" for "sensor_msgs::msg::dds_::Image_"; of another text what can be shown.
std::string ros_type_from_wire(const std::string& type);

struct TopicImagesOptions {
  std::string topic;  ///< "/camera/image_raw"
  ImageRanges ranges;
  /// Makes a frame of the bytes of a JPEG or PNG file; throws Error when they are none.
  std::function<Frame(std::span<const std::uint8_t> file)> decode;
  double silence_s = 1;      ///< After so long without an image the topic is silent. [s], > 0
  double turned_back_s = 2;  ///< After so long of nothing but older stamps it is over. [s], > 0
};

/// Images that were published and are not seen, and why.
struct TopicImageCounts {
  std::int64_t missed = 0;   ///< Replaced by newer ones before anybody took them, or lost on the way.
  std::int64_t older = 0;    ///< Their stamp was that of the image before, or older.
  std::int64_t refused = 0;  ///< Of no use: see `last_refusal`.
  std::int64_t silences = 0;
  std::string last_refusal;
};

/// The newest image of a topic, be it sensor_msgs/Image or sensor_msgs/CompressedImage: whoever publishes first
/// decides. So it does of reliability: an image is a thousand packets, one of which is often lost where the receiver's
/// buffer is smaller, so that what is offered reliably is asked for reliably, and the rest as best effort.
///
/// Pixels stay in the message's own bytes where frame_from says so. Once there was an image, all others must have its
/// size and range; what is not so, or malformed, is refused and counted, and nobody can end a run with it.
/// Index: all images of the topic from the first one on, with those that were not seen.
/// Time: the stamp, rising; the time of arrival where it is 0, which is "not set" to ROS. Older images are dropped. An
/// image from the future would stop all others: after turned_back_s of nothing but older ones it is over.
///
/// threads  one at a time
class TopicImages {
 public:
  TopicImages(Bus& bus, TopicImagesOptions options);

  /// The newest image that has come since the last time, or nothing; never waits.
  ///
  /// now  on any clock that does not stop, the same each time. [s]
  /// Throws Error when the topic is published as another type only, when its first image has an encoding that is not
  /// known, and when stamps went back and stay there.
  std::optional<Frame> take(double now);

  /// What happened since the last call, for people, in lines without their ends: waiting, silent, back, two
  /// drivers at once.
  std::vector<std::string> news() { return std::exchange(news_, {}); }
  TopicImageCounts counts() const;
  /// "sensor_msgs/msg/Image, uyvy422 384x172 px, limited range"; of the first image.
  const std::string& description() const { return description_; }
  /// From its stamp to its arrival, of the last image; on one machine that of the driver and the way. [s]
  double delay_s() const { return delay_s_; }

 private:
  void look_for_publisher(double now);
  void listen_anew();
  bool is_compressed() const;
  std::optional<Frame> frame_of(BusSample sample);
  Frame read(const std::shared_ptr<const std::vector<std::byte>>& bytes, double& t) const;
  void watch_writer(const BusId& writer);
  bool is_newer(double t, double now);
  void note_first(const Frame& frame);
  void image_came(double now);
  void nothing_came(double now);
  std::string why_silent() const;
  void refuse(const std::string& reason);

  Bus& bus_;
  TopicImagesOptions options_;
  std::string subject_;  ///< "topic /camera/image_raw"
  std::string type_;     ///< On the wire; empty while nobody has published. A bus has one type a topic, so it stays.
  std::optional<BusReader> reader_;
  std::vector<std::string> news_;
  TopicImageCounts counts_;
  std::string description_;  ///< Empty before the first image.
  int width_ = 0, height_ = 0;
  ColorRange range_ = ColorRange::limited;
  std::optional<BusId> writer_;  ///< Of the last message.
  bool is_mixture_told_ = false;
  std::int64_t taken_ = 0;
  std::optional<std::int64_t> first_;  ///< Position of the first image among all.
  std::optional<double> newest_;       ///< Its stamp. [s]
  double delay_s_ = 0;
  // On the caller's clock. [s]
  std::optional<double> waits_since_, last_image_at_, older_since_;
  enum class State { waiting, waiting_told, waiting_for_images_told, streaming, silent };
  State state_ = State::waiting;
  bool is_gone_told_ = false;  ///< While silent.
};

}  // namespace tassilo
