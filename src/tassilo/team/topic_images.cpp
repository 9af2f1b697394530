#include "tassilo/team/topic_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/message/codec.h"
#include "tassilo/message/from_scene.h"

namespace tassilo {
namespace {

constexpr std::string_view kGone = "nobody publishes it any more";
constexpr double kDiscovery = 0.5;  // who is there is known by then [s]

std::string seconds_text(double seconds) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f s", seconds);
  return text.data();
}

std::string pixels_text(int width, int height, ColorRange range) {
  return std::to_string(width) + "x" + std::to_string(height) + " px, " + std::string(to_string(range)) + " range";
}

double time_of(const ros::Header& header) {
  if (header.stamp.sec < 0 || header.stamp.nanosec >= 1'000'000'000)
    throw Error("image", "has a stamp that is no time");
  return seconds_of(header.stamp);
}

}  // namespace

bool is_ros_topic_name(std::string_view name) {
  constexpr std::size_t longest = 200;  // 255 on the wire, and whatever is put before it
  if (name.size() < 2 || name.size() > longest || name.back() == '/') return false;
  char before = 0;
  for (const char c : name) {
    const bool is_digit = c >= '0' && c <= '9';
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    if (before == 0 ? c != '/' : before == '/' ? !is_letter : !is_letter && !is_digit && c != '/') return false;
    before = c;
  }
  return true;
}

std::vector<std::string> published_types(const Bus& bus, std::string_view ros_name) {
  const std::string name = wire_topic_name(ros_name);
  std::vector<std::string> types;
  for (const BusEndpoint& writer : bus.publications())
    if (writer.topic == name && std::ranges::find(types, writer.type) == types.end()) types.push_back(writer.type);
  return types;
}

BusReliability offered_by_all(const Bus& bus, std::string_view ros_name, std::string_view wire_type) {
  const std::string name = wire_topic_name(ros_name);
  const std::vector<BusEndpoint> writers = bus.publications();
  const bool is_reliable = std::ranges::all_of(writers, [&](const BusEndpoint& writer) {
    return writer.topic != name || writer.type != wire_type || writer.reliability == BusReliability::reliable;
  });
  return is_reliable ? BusReliability::reliable : BusReliability::best_effort;
}

std::string ros_type_from_wire(const std::string& type) {
  constexpr std::string_view middle = "::msg::dds_::";
  const auto at = type.find(middle);
  std::string name = type;
  if (at != std::string::npos && type.ends_with('_'))
    name = type.substr(0, at) + "/msg/" + type.substr(at + middle.size(), type.size() - at - middle.size() - 1);
  constexpr std::size_t longest = 100;
  name.resize(std::min(name.size(), longest));
  for (char& c : name) c = c > ' ' && c <= '~' ? c : '?';
  return name;
}

bool TopicImages::is_compressed() const { return type_ == wire_type_name<ros::CompressedImage>(); }

TopicImages::TopicImages(Bus& bus, TopicImagesOptions options)
    : bus_(bus), options_(std::move(options)), subject_("topic " + options_.topic) {
  expects(options_.silence_s > 0 && options_.turned_back_s > 0, "TopicImages: patience > 0");
  expects(options_.decode != nullptr, "TopicImages: somebody decodes compressed images");
}

std::optional<Frame> TopicImages::take(double now) {
  if (!waits_since_) waits_since_ = now;
  if (!reader_) look_for_publisher(now);
  std::optional<Frame> newest;
  if (reader_)
    for (BusSample& sample : reader_->take())
      if (auto frame = frame_of(std::move(sample)); frame && is_newer(frame->t, now)) newest = std::move(frame);
  if (newest)
    image_came(now);
  else
    nothing_came(now);
  return newest;
}

TopicImageCounts TopicImages::counts() const {
  TopicImageCounts counts = counts_;
  if (reader_) {
    counts.missed += reader_->lost();
    counts.refused += reader_->refused();
  }
  return counts;
}

/// A driver that was started anew may be less reliable.
void TopicImages::listen_anew() {
  counts_ = counts();
  reader_.reset();
}

void TopicImages::look_for_publisher(double now) {
  const std::vector<std::string> types = published_types(bus_, options_.topic);
  const auto is_published = [&](const std::string& type) { return std::ranges::find(types, type) != types.end(); };
  if (types.empty()) return;
  if (type_.empty()) {
    for (const std::string& type : {wire_type_name<ros::Image>(), wire_type_name<ros::CompressedImage>()})
      if (type_.empty() && is_published(type)) type_ = type;
    if (type_.empty())
      throw Error(subject_, "is published as " + ros_type_from_wire(types.front()) +
                                ", must be sensor_msgs/msg/Image or sensor_msgs/msg/CompressedImage");
  }
  if (!is_published(type_)) return;
  BusTopic topic;
  topic.name = wire_topic_name(options_.topic);
  topic.type = type_;
  topic.reliability = offered_by_all(bus_, options_.topic, type_);
  reader_.emplace(bus_.reader(topic));
  waits_since_ = now;
}

Frame TopicImages::read(const std::shared_ptr<const std::vector<std::byte>>& bytes, double& t) const {
  if (is_compressed()) {
    const auto message = decoded<ros::BorrowedCompressedImage>(*bytes);
    if (!message) throw Error("image", "is no whole sensor_msgs/msg/CompressedImage");
    t = time_of(message->header);
    return options_.decode(message->data);
  }
  const auto message = decoded<ros::BorrowedImage>(*bytes);
  if (!message) throw Error("image", "is no whole sensor_msgs/msg/Image");
  t = time_of(message->header);
  return frame_from(*message, options_.ranges, bytes);
}

std::optional<Frame> TopicImages::frame_of(BusSample sample) {
  const double arrival = 1e-9 * static_cast<double>(sample.arrival_ns);
  watch_writer(sample.writer);
  const std::int64_t position = taken_++ + counts_.missed + reader_->lost();
  try {
    double t = 0;
    Frame frame = read(std::make_shared<const std::vector<std::byte>>(std::move(sample.data)), t);
    if (description_.empty()) {
      note_first(frame);
      first_ = position;
    }
    if (frame.view.width() != width_ || frame.view.height() != height_ || frame.range != range_)
      throw Error("image", "has " + pixels_text(frame.view.width(), frame.view.height(), frame.range) +
                               ", must have that of the first one: " + pixels_text(width_, height_, range_));
    frame.t = t > 0 ? t : arrival;
    frame.index = position - *first_;
    delay_s_ = arrival - frame.t;
    return frame;
  } catch (const UnknownEncoding& unknown) {
    if (description_.empty()) throw Error(subject_, unknown.what());
    refuse(unknown.what());
  } catch (const Error& refusal) {
    refuse(refusal.what());
  }
  return std::nullopt;
}

/// A driver that was started anew is another writer, too, but then the former one is gone.
void TopicImages::watch_writer(const BusId& writer) {
  const std::optional<BusId> before = std::exchange(writer_, writer);
  if (is_mixture_told_ || !before || *before == writer) return;
  const std::vector<BusEndpoint> writers = bus_.publications();
  if (std::ranges::find(writers, *before, &BusEndpoint::id) == writers.end()) return;
  is_mixture_told_ = true;
  news_.push_back(subject_ + " has two publishers at once, whose images are mixed");
}

void TopicImages::note_first(const Frame& frame) {
  width_ = frame.view.width();
  height_ = frame.view.height();
  range_ = frame.range;
  description_ = ros_type_from_wire(type_) + ", " + std::string(to_string(frame.view.format())) + " " +
                 pixels_text(width_, height_, range_);
}

bool TopicImages::is_newer(double t, double now) {
  if (!newest_ || t > *newest_) {
    newest_ = t;
    older_since_.reset();
    return true;
  }
  ++counts_.older;
  if (!older_since_) older_since_ = now;
  if (now - *older_since_ > options_.turned_back_s)
    throw Error(subject_, "has stamps that went back by " + seconds_text(*newest_ - t) +
                              " and stay there: a clock was set, or something was sent from the future; start again");
  return false;
}

void TopicImages::refuse(const std::string& reason) {
  ++counts_.refused;
  counts_.last_refusal = reason;
}

void TopicImages::image_came(double now) {
  if (state_ == State::silent)
    news_.push_back("back: " + subject_ + " after " + seconds_text(now - last_image_at_.value_or(now)));
  state_ = State::streaming;
  last_image_at_ = now;
}

void TopicImages::nothing_came(double now) {
  const double waited = now - *waits_since_;
  switch (state_) {
    case State::waiting:
      if (!reader_ && waited >= kDiscovery) {
        state_ = State::waiting_told;
        news_.push_back("waiting for " + subject_ + ", which nobody publishes");
      }
      [[fallthrough]];
    case State::waiting_told:
      if (reader_ && waited >= options_.silence_s) {
        state_ = State::waiting_for_images_told;
        news_.push_back("waiting for images of " + subject_ + ": " + why_silent());
      }
      break;
    case State::streaming:
      if (now - last_image_at_.value_or(now) >= options_.silence_s) {
        state_ = State::silent;
        ++counts_.silences;
        const std::string why = why_silent();
        is_gone_told_ = why == kGone;
        news_.push_back("silent: " + subject_ + " has sent no image for " + seconds_text(now - *last_image_at_) + ": " +
                        why);
      }
      break;
    case State::silent:
      if (reader_ && reader_->writers() == 0) listen_anew();
      // Who was killed is gone only after its lease.
      if (!is_gone_told_ && published_types(bus_, options_.topic).empty()) {
        is_gone_told_ = true;
        news_.push_back("silent: " + subject_ + ": " + std::string(kGone));
      }
      break;
    case State::waiting_for_images_told:
      break;
  }
}

std::string TopicImages::why_silent() const {
  const std::vector<std::string> types = published_types(bus_, options_.topic);
  if (types.empty()) return std::string(kGone);
  if (std::ranges::find(types, type_) == types.end())
    return "it is now published as " + ros_type_from_wire(types.front()) + "; start again";
  const TopicImageCounts now = counts();
  if (older_since_) return "all that come are older than the last one";
  if (now.refused > 0 && !now.last_refusal.empty())
    return std::to_string(now.refused) + " were refused, the last: " + now.last_refusal;
  if (now.refused > 0) return std::to_string(now.refused) + " were refused, as they are too large or empty";
  return "it has a publisher, which sends none";
}

}  // namespace tassilo
