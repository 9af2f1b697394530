#include "tassilo/app/team_log.h"

#include <algorithm>

#include "tassilo/base/error.h"
#include "tassilo/message/plausible.h"

namespace tassilo {
namespace {

constexpr double kLookBack = 10;    // until everything that is told is there, and older trails are not drawn [s]
constexpr double kGoOn = 10;        // further away, beginning again is quicker [s]
constexpr double kTrailStep = 0.1;  // [s]
constexpr double kPictureAge = 2;   // [s]

double seconds(std::int64_t nanoseconds) { return 1e-9 * static_cast<double>(nanoseconds); }
std::int64_t nanoseconds(double t) { return static_cast<std::int64_t>(t * 1e9); }

/// Who published it: as the log says, else its topic's robot.
std::string sender_of(const McapChannel& channel) {
  const auto said = std::ranges::find(channel.metadata, "sender", &McapPairs::value_type::first);
  return said != channel.metadata.end() ? said->second : "log";
}

}  // namespace

TeamLog::TeamLog(const std::filesystem::path& file, const TeamViewOptions& options, const TeamFusionOptions& fusion)
    : reader_(file),
      picture_reader_(file),
      options_(options),
      fusion_options_(fusion),
      begin_(seconds(reader_.begin_ns())),
      end_(seconds(reader_.end_ns())),
      view_(options),
      bench_(fusion),
      trails_(2 * kLookBack) {
  bool has_robots = false;
  for (const auto& [number, channel] : reader_.channels()) {
    const RobotTopic topic = robot_topic_from(channel.topic);
    has_robots = has_robots || topic.robot >= 0;
    if (topic.robot >= 0 && topic.topic->name == kImageTopic.name) with_pictures_.push_back(topic.robot);
  }
  if (!has_robots) throw Error(file.string(), "has no topics of a robot, /robot<id>/...");
  std::ranges::sort(with_pictures_);
}

void TeamLog::begin_before(double t) {
  view_ = TeamView(options_);
  bench_ = TeamBench(fusion_options_);
  trails_.clear();
  ahead_.reset();
  // In whole nanoseconds: the first message is not passed over for the last digit of its time.
  const std::int64_t from = std::max(reader_.begin_ns(), nanoseconds(t - kLookBack));
  reader_.seek(from);
  now_ = seconds(from);
}

TeamPicture TeamLog::at(double t) {
  t = std::clamp(t, begin_, end_);
  if (!now_ || t < *now_ || t > *now_ + kGoOn) begin_before(t);
  double next_step = *now_ + kTrailStep;
  constexpr double last_digits = 1e-3;  // at the end all of it is heard, but not what is of no time of the log [s]
  const double until = t < end_ ? t : end_ + last_digits;
  for (;;) {
    if (!ahead_) {
      ahead_ = reader_.next();
      if (ahead_) ahead_data_.assign(ahead_->data.begin(), ahead_->data.end());
    }
    if (!ahead_ || seconds(ahead_->log_time_ns) > until) break;
    const double arrival = seconds(ahead_->log_time_ns);
    for (; next_step < arrival; next_step += kTrailStep) trails_.add(view_.picture(next_step));
    const McapChannel& channel = reader_.channels().at(ahead_->channel);
    if (channel.message_encoding == "cdr" && robot_topic_from(channel.topic).robot >= 0) {
      const std::string sender = sender_of(channel);
      const Heard heard{channel.topic, sender, arrival, ahead_data_};
      if (const auto believed = view_.hear(heard)) bench_.hear(heard, *believed);
    }
    ahead_.reset();
  }
  now_ = t;
  TeamPicture picture = view_.picture(t);
  trails_.add(picture);
  return picture;
}

std::vector<TeamTrail> TeamLog::trails(double t, double seconds) {
  if (!now_ || t > *now_ || t < *now_ - kLookBack) at(t);
  return trails_.before(t, seconds);
}

std::vector<TeamNews> TeamLog::news() const {
  std::vector<TeamNews> news(view_.news().begin(), view_.news().end());
  std::int64_t last = 0;
  for (TeamNews& one : news) {
    constexpr double per_second = 1e4;
    one.number = last = std::max(last + 1, 1 + static_cast<std::int64_t>((one.t - begin_) * per_second));
  }
  return news;
}

std::optional<std::string> TeamLog::picture(int robot, double t) {
  const std::string topic = ros_topic_name(kImageTopic, robot);
  std::optional<std::string> newest;
  t = std::clamp(t, begin_, end_);
  picture_reader_.seek(nanoseconds(std::max(begin_, t - kPictureAge)));
  while (const auto message = picture_reader_.next()) {
    if (seconds(message->log_time_ns) > t) break;
    if (picture_reader_.channels().at(message->channel).topic != topic) continue;
    const auto picture = decoded<ros::CompressedImage>(message->data);
    if (picture && implausible(*picture, robot).empty()) newest.emplace(picture->data.begin(), picture->data.end());
  }
  return newest;
}

}  // namespace tassilo
