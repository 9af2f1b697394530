#include "tassilo/app/team_bench.h"

#include <algorithm>

#include "tassilo/message/to_scene.h"

namespace tassilo {
namespace {

/// Messages of one image are sent one after the other. What is missing after this was lost or withheld. [s]
constexpr double kPatience = 0.1;
/// Images are known for so long beyond the history: what is of an older one is too late for the fusion. [s]
constexpr double kKeptLonger = 0.5;
constexpr std::size_t kMostImages = 2048;      // ten robots have 450
constexpr std::size_t kMostImagesOfOne = 128;  // one has 45
constexpr double kTellsColor = 5;              // who was silent for longer is gone [s]
constexpr double kColorStep = 1;  // beginning anew costs milliseconds: not for everybody who asks for it [s]

}  // namespace

TeamBench::TeamBench(const TeamFusionOptions& options) : options_(options), fusion_(options) {
  options_.own_team = Team::unknown;
  fusion_ = TeamFusion(options_);
}

void TeamBench::hear(const Heard& heard, const Believed& believed) {
  const double now = heard.arrival;
  give_due(now);
  const RobotTopic topic = robot_topic_from(heard.topic);
  if (topic.robot != believed.robot) return;
  const std::string_view name = topic.topic->name;
  if (name != kPoseTopic.name && name != kBallsTopic.name && name != kRobotsTopic.name && name != kTeamStateTopic.name)
    return;
  const Key key{believed.robot, believed.stamp};
  auto found = images_.find(key);
  if (found == images_.end()) {
    // Who begins images without end crowds out its own, nobody else's.
    if (waiting_[key.first] >= kMostImagesOfOne)
      forget(static_cast<std::size_t>(std::ranges::find(order_, key.first, &Key::first) - order_.begin()));
    found = images_.emplace(key, Image{now, believed.t, {}, {}, {}, {}, false}).first;
    order_.push_back(key);
    ++waiting_[key.first];
  }
  Image& image = found->second;
  if (name == kPoseTopic.name) {
    if (const auto message = decoded<ros::PoseWithCovarianceStamped>(heard.data)) image.pose = pose_from(*message);
  } else if (name == kBallsTopic.name) {
    if (const auto message = decoded<msgs::BallArray>(heard.data)) image.balls = balls_from(*message);
  } else if (name == kRobotsTopic.name) {
    if (const auto message = decoded<msgs::RobotArray>(heard.data)) image.robots = robots_from(*message);
  } else if (auto message = decoded<msgs::TeamState>(heard.data)) {
    image.state = *message;
    voices_[believed.robot] = {std::move(*message), now};
    ask_color(now);
  }
  const bool is_whole = image.pose && image.balls && image.robots && image.state;
  if (is_whole || now >= image.heard_at + kPatience) give(key, image, now);
}

/// Once, and only with a pose of its own and something to combine.
void TeamBench::give(const Key& key, Image& image, double now) {
  if (image.is_given || !image.pose || (!image.balls && !image.robots)) return;
  image.is_given = true;
  if (image.state && !pose_kind_from(image.state->pose_kind)) return;  // it takes the pose back
  const auto voice = voices_.find(key.first);
  if (image.state)
    add_state(*image.pose, *image.state);
  else if (voice != voices_.end())
    add_state(*image.pose, voice->second.state);
  TeamObservation observation;
  observation.robot = key.first;
  observation.stamp = key.second;
  observation.t = image.t;
  observation.pose = image.pose;
  if (image.balls) observation.balls = std::move(*image.balls);
  if (image.robots) observation.robots = std::move(*image.robots);
  if (fusion_.add(observation, now) != Contribution::taken) return;
  recent_.push_back(std::move(observation));
  while (!recent_.empty() && (recent_.size() > static_cast<std::size_t>(options_.max_observations) ||
                              recent_.front().t < now - options_.history - kKeptLonger))
    recent_.pop_front();
}

/// What waited long enough is given as it is, and what is too old for anything is forgotten.
void TeamBench::give_due(double now) {
  const auto is_older = [&](const Key& key, double age) { return images_.at(key).heard_at <= now - age; };
  while (due_ < order_.size() && is_older(order_[due_], kPatience)) {
    const Key key = order_[due_++];
    Image& image = images_.at(key);
    give(key, image, image.heard_at + kPatience);  // whenever somebody asks
  }
  while (!order_.empty() && (order_.size() > kMostImages || is_older(order_.front(), options_.history + kKeptLonger))) {
    forget(0);
  }
}

/// The image that is `at` in the order.
void TeamBench::forget(std::size_t at) {
  const Key key = order_[at];
  if (--waiting_.at(key.first) == 0) waiting_.erase(key.first);
  images_.erase(key);
  order_.erase(order_.begin() + static_cast<std::ptrdiff_t>(at));
  if (at < due_) --due_;
}

/// Soon after a color is told, whoever asks for the team meanwhile: what is looked back at is as it was live.
void TeamBench::ask_color(double now) {
  if (now >= asked_at_ && now - asked_at_ < kColorStep) return;
  std::optional<Team> color;
  bool is_one = true;
  for (const auto& [robot, voice] : voices_) {
    const Team team = team_from(voice.state.team);
    if (team == Team::unknown || now - voice.told_at > kTellsColor) continue;
    is_one = is_one && (!color || *color == team);
    color = team;
  }
  // While nobody tells, what was told goes on.
  if (!color) return;
  asked_at_ = now;
  const Team own = is_one ? *color : Team::unknown;
  if (own == options_.own_team) return;
  options_.own_team = own;
  fusion_ = TeamFusion(options_);
  for (const TeamObservation& observation : recent_) fusion_.add(observation, now);
}

TeamWorld TeamBench::at(double now) {
  give_due(now);
  ask_color(now);
  return fusion_.at(now);
}

}  // namespace tassilo
