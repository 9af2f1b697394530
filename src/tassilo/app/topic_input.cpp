#include "tassilo/app/topic_input.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <string_view>

#include "tassilo/app/unix_clock.h"
#include "tassilo/base/error.h"
#include "tassilo/message/codec.h"
#include "tassilo/message/odometry_sample.h"
#include "tassilo/source/frame_reader.h"
#include "tassilo/source/picture.h"

namespace tassilo {
namespace {

constexpr std::string_view kScheme = "topic:";
constexpr std::chrono::milliseconds kPatience(100);          // how long an interruption may be overlooked
constexpr double kAwaited = 5;                               // what has not come by then is told to be missing [s]
constexpr double kStrangeClock = 10;                         // stamps that far off are of another clock [s]
constexpr std::size_t kMostSamples = 4096;                   // of odometry that nobody takes
constexpr std::int64_t kMostPixels = std::int64_t{1} << 25;  // of a compressed image

double steady_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

BusTopic bus_topic(const std::string& name, std::string type, int depth) {
  BusTopic topic;
  topic.name = wire_topic_name(name);
  topic.type = std::move(type);
  topic.depth = depth;
  return topic;
}

std::string lens_size(const ToldLens& lens) { return fmt::format("{}x{}", lens.width, lens.height); }

bool same(const std::optional<ToldLens>& a, const std::optional<ToldLens>& b) {
  return a.has_value() == b.has_value() &&
         (!a || (a->width == b->width && a->height == b->height && a->model == b->model));
}

}  // namespace

bool is_topic(const std::string& location) { return location.starts_with(kScheme); }
std::string topic_of(const std::string& location) { return location.substr(kScheme.size()); }

/// Images as any other source gives frames.
class TopicInput::Reader final : public FrameReader {
 public:
  Reader(TopicInput& input, std::function<bool()> interrupted) : input_(input), interrupted_(std::move(interrupted)) {}

  std::optional<Frame> next() override { return input_.next_image(interrupted_); }
  SourceInfo info() const override {
    SourceInfo info;
    info.name = fmt::format("topic {}", input_.topics_.images);
    info.description = input_.images_->description();
    info.live = true;
    return info;
  }
  /// Stamps of a simulated clock say nothing of latency.
  std::optional<double> now() const override {
    if (std::abs(input_.images_->delay_s()) > kStrangeClock) return std::nullopt;
    return unix_now();
  }

 private:
  TopicInput& input_;
  std::function<bool()> interrupted_;
};

TopicInput::TopicInput(const BusOptions& bus, InputTopics topics)
    : bus_(bus), topics_(std::move(topics)), began_at_(steady_s()) {
  if (!topics_.images.empty() && topics_.camera_info.empty())
    topics_.camera_info = camera_info_topic_of(topics_.images);
  if (!topics_.camera_info.empty())
    camera_info_.emplace(bus_.reader(bus_topic(topics_.camera_info, wire_type_name<ros::CameraInfo>(), 1)));
  constexpr int depth = 1000;  // five seconds at 200 Hz
  if (!topics_.odometry.empty())
    odometry_.emplace(bus_.reader(bus_topic(topics_.odometry, wire_type_name<ros::Odometry>(), depth)));
}

FrameSource TopicInput::open_images(const SourceOptions& options, std::optional<ColorRange> range) {
  TopicImagesOptions images;
  images.topic = topics_.images;
  images.ranges.rgb = options.images_range;
  images.ranges.yuv = range.value_or(ColorRange::limited);
  images.decode = [range = options.images_range](std::span<const std::uint8_t> file) {
    return decode_picture(file, {.name = "image", .images_range = range, .max_pixels = kMostPixels});
  };
  images_.emplace(bus_, std::move(images));
  return FrameSource(std::make_unique<Reader>(*this, options.interrupted));
}

std::optional<Frame> TopicInput::next_image(const std::function<bool()>& interrupted) {
  while (!interrupted || !interrupted()) {
    std::optional<Frame> frame = images_->take(steady_s());
    for (const std::string& line : images_->news()) tell(line);
    // Whatever came must be taken: the bus does not wait while there is something.
    pump();
    if (frame && !first_image_at_) first_image_at_ = steady_s();
    if (frame) return frame;
    bus_.wait(kPatience);
  }
  return std::nullopt;
}

void TopicInput::pump() {
  if (camera_info_) listen_to_camera_info();
  if (odometry_) listen_to_odometry();
}

void TopicInput::listen_to_camera_info() {
  for (const BusSample& sample : camera_info_->take()) {
    try {
      const auto info = decoded<ros::CameraInfo>(sample.data);
      if (!info) throw Error("camera info", "is no whole sensor_msgs/msg/CameraInfo");
      lens_ = lens_from(*info, is_rectified_topic(topics_.images));
    } catch (const Error& refusal) {
      if (refused_infos_++ > 0) continue;
      first_info_refusal_ = refusal.what();
      tell(fmt::format("topic {}: {}; the camera file is not checked", topics_.camera_info, refusal.what()));
    }
  }
}

void TopicInput::listen_to_odometry() {
  for (const BusSample& sample : odometry_->take()) add(sample);
  if (odometry_came_ > 0 || has_told_no_odometry_) return;
  const std::vector<std::string> types = published_types(bus_, topics_.odometry);
  const std::string own = wire_type_name<ros::Odometry>();
  bool is_there = types.empty();
  for (const std::string& type : types) is_there = is_there || type == own;
  if (!is_there)
    throw Error(fmt::format("topic {}", topics_.odometry),
                fmt::format("is published as {}, must be nav_msgs/msg/Odometry", ros_type_from_wire(types.front())));
  if (steady_s() - began_at_ < kAwaited) return;
  has_told_no_odometry_ = true;
  tell(fmt::format("waiting for topic {}, {}", topics_.odometry,
                   types.empty() ? "which nobody publishes" : "whose publisher sends nothing"));
}

void TopicInput::add(const BusSample& sample) {
  ++odometry_came_;
  const auto message = decoded<ros::Odometry>(sample.data);
  const std::string refusal = message ? unusable(*message) : "it is no whole nav_msgs/msg/Odometry";
  if (!refusal.empty()) {
    if (odometry_refused_++ == 0) first_odometry_refusal_ = refusal;
    return;
  }
  if (samples_.size() == kMostSamples) {
    samples_.erase(samples_.begin(), samples_.begin() + kMostSamples / 2);
    odometry_dropped_ += kMostSamples / 2;
  }
  samples_.push_back(odometry_sample_from(*message));
}

std::vector<OdometrySample> TopicInput::take_odometry() {
  pump();
  return std::exchange(samples_, {});
}

void TopicInput::check_camera(const std::optional<CameraModel>& camera) {
  if (!camera || topics_.images.empty()) return;
  if (!lens_) {
    if (has_told_no_info_ || refused_infos_ > 0 || steady_s() - first_image_at_.value_or(steady_s()) < kAwaited) return;
    has_told_no_info_ = true;
    tell(fmt::format("topic {} has sent no sensor_msgs/msg/CameraInfo; the camera file is not checked",
                     topics_.camera_info));
    return;
  }
  if (same(lens_, compared_) && camera == compared_to_) return;
  compared_ = lens_;
  compared_to_ = camera;
  std::string fault;
  if (lens_->width != camera->width || lens_->height != camera->height) {
    fault = fmt::format("is for {} px, the camera file for {}x{}", lens_size(*lens_), camera->width, camera->height);
  } else if (!lens_->model) {
    tell(fmt::format("topic {}: is of a camera that was not calibrated; the camera file is not checked",
                     topics_.camera_info));
    return;
  } else {
    const LensDifference most = difference(*camera, *lens_->model);
    if (!(most.px <= kMostLensDifference))
      fault = fmt::format("differs from the camera file by {} at pixel ({:.0f}, {:.0f}), must be within {:.0f} px",
                          std::isinf(most.px) ? "more than can be said" : fmt::format("{:.1f} px", most.px), most.at.x,
                          most.at.y, kMostLensDifference);
  }
  if (fault.empty()) {
    has_agreed_ = true;
    return;
  }
  const std::string subject = fmt::format("topic {}", topics_.camera_info);
  fault +=
      "; correct the one that is wrong: the driver's calibration, or the camera file by `tassilo calibrate "
      "intrinsics`";
  if (!has_agreed_) throw Error(subject, fault);
  tell(fmt::format("{}: {}", subject, fault));
}

std::string TopicInput::summary() const {
  std::string text;
  if (images_) {
    const TopicImageCounts counts = images_->counts();
    std::string line;
    const auto append = [&](std::int64_t count, const std::string& words) {
      if (count > 0) line += fmt::format("{}{} {}", line.empty() ? "" : ", ", count, words);
    };
    append(counts.missed, "replaced by newer ones or lost on the way");
    append(counts.older, "with an older stamp");
    append(counts.refused, counts.last_refusal.empty() ? "refused" : "refused, the last: " + counts.last_refusal);
    if (counts.silences > 0)
      line +=
          fmt::format("{}silent {} time{}", line.empty() ? "" : "; ", counts.silences, counts.silences == 1 ? "" : "s");
    if (!line.empty()) text += "images: " + line + "\n";
  }
  if (refused_infos_ > 0)
    text += fmt::format("camera info: {} refused, the first: {}\n", refused_infos_, first_info_refusal_);
  if (odometry_refused_ > 0)
    text += fmt::format("odometry: {} of {} messages refused, the first: {}\n", odometry_refused_, odometry_came_,
                        first_odometry_refusal_);
  const std::int64_t lost = odometry_dropped_ + (odometry_ ? odometry_->lost() : 0);
  if (lost > 0) text += fmt::format("odometry: {} messages lost\n", lost);
  return text;
}

void TopicInput::tell(const std::string& line) const {
  if (news_) news_(line);
}

}  // namespace tassilo
