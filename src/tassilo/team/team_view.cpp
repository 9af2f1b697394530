#include "tassilo/team/team_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "tassilo/base/error.h"
#include "tassilo/message/from_scene.h"
#include "tassilo/message/plausible.h"
#include "tassilo/message/to_scene.h"

namespace tassilo {
namespace {

constexpr double kTroubleLasts = 5;      // what has not happened for so long is over [s]
constexpr double kTallied = 5;           // loss is told of so long [s]
constexpr std::size_t kRemembered = 64;  // stamps, to know what is repeated: two seconds of images

std::string with_digits(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string clock_words(double ahead) {
  return "its clock is " + with_digits(std::abs(ahead), 1) + " s " + (ahead > 0 ? "ahead" : "behind");
}

}  // namespace

std::string_view to_string(Presence presence) {
  constexpr std::array<std::string_view, 3> names{"here", "stale", "gone"};
  return names.at(static_cast<std::size_t>(presence));
}

void TeamViewOptions::check() const {
  const auto refuse = [](const char* name, double value, const std::string& must) {
    throw Error(std::string("team.") + name, "is " + with_digits(value, 3) + ", must be " + must);
  };
  if (!(stale_s > 0 && stale_s <= 3600)) refuse("stale_s", stale_s, "> 0 and at most 3600");
  if (!(gone_s > stale_s && gone_s <= 3600)) refuse("gone_s", gone_s, "> stale_s and at most 3600");
  if (!(forget_s > gone_s && forget_s <= 86400)) refuse("forget_s", forget_s, "> gone_s and at most 86400");
  if (!(clock_tolerance_s > 0)) refuse("clock_tolerance_s", clock_tolerance_s, "> 0");
  for (const int robot : known_robots)
    if (robot < 0 || robot > 255) refuse("known_robots", robot, "0..255");
}

TeamView::TeamView(const TeamViewOptions& options) : options_(options) { options_.check(); }

std::optional<Believed> TeamView::hear(const Heard& heard) {
  ++counts_.heard;
  bytes_.add(heard.arrival, static_cast<double>(heard.data.size()));
  const RobotTopic topic = robot_topic_from(heard.topic);
  const bool is_known =
      topic.robot >= 0 && (options_.known_robots.empty() ||
                           std::ranges::find(options_.known_robots, topic.robot) != options_.known_robots.end());
  if (topic.topic != nullptr && topic.topic->name == kTransformsTopic.name)
    return std::nullopt;  // of poses that are told, too
  if (!is_known) {
    ++counts_.refused;
    if (heard.arrival - stranger_at_ > kTroubleLasts && topic.robot >= 0)
      tell(heard.arrival, topic.robot, "is no robot of the team: not believed");
    stranger_at_ = heard.arrival;
    stranger_ = std::string(heard.topic.substr(0, 100));
    return std::nullopt;
  }
  const Judgment judgment = hear_of_robot(heard, topic);
  if (judgment.is_refused) ++counts_.refused;
  return judgment.believed;
}

TeamView::Judgment TeamView::hear_of_robot(const Heard& heard, const RobotTopic& topic) {
  auto found = members_.find(topic.robot);
  if (found == members_.end()) {
    found = members_.emplace(topic.robot, Member{}).first;
    found->second.told.id = topic.robot;
  }
  Member& member = found->second;
  const std::string_view name = topic.topic->name;
  // The scan is the free space once more, and pictures are not kept.
  if (name == kScanTopic.name || name == kImageTopic.name) return {};
  if (name == kPoseTopic.name) return take<ros::PoseWithCovarianceStamped>(member, heard, *topic.topic);
  if (name == kBallsTopic.name) return take<msgs::BallArray>(member, heard, *topic.topic);
  if (name == kGoalsTopic.name) return take<msgs::GoalArray>(member, heard, *topic.topic);
  if (name == kRobotsTopic.name) return take<msgs::RobotArray>(member, heard, *topic.topic);
  if (name == kLinesTopic.name) return take<msgs::LineArray>(member, heard, *topic.topic);
  if (name == kTracksTopic.name) return take<msgs::TrackArray>(member, heard, *topic.topic);
  if (name == kFreeSpaceTopic.name) return take<msgs::FreeSpace>(member, heard, *topic.topic);
  if (name == kTeamStateTopic.name) return take<msgs::TeamState>(member, heard, *topic.topic);
  if (name == kOdometryTopic.name) return take<ros::Odometry>(member, heard, *topic.topic);
  return {.is_refused = true};
}

bool TeamView::is_from_whom_we_believe(Member& member, const Heard& heard) {
  if (member.sender == heard.sender) return true;
  const bool is_first = member.sender.empty();
  if (!is_first && heard.arrival - member.last_heard < options_.stale_s) {
    if (!member.is_announced_double)
      tell(heard.arrival, member.told.id, "two senders have its number; the first one is believed");
    member.is_announced_double = true;
    member.other_heard = heard.arrival;
    ++member.told.refused;
    return false;
  }
  // Nothing of the one before says anything of this one: not its clock, not its counts.
  Member next;
  next.told.id = member.told.id;
  next.told.refused = member.told.refused;
  next.refused_at = member.refused_at;
  next.refusal = member.refusal;
  next.sender = heard.sender;
  if (!is_first) {
    tell(heard.arrival, member.told.id, "was started again, or another has taken its number");
    next.last_heard = heard.arrival;
  }
  member = std::move(next);
  return true;
}

template <Message M>
TeamView::Judgment TeamView::take(Member& member, const Heard& heard, const Topic& topic) {
  const std::optional<M> message = decoded<M>(heard.data);
  if (!message) return refuse(member, heard, std::string(topic.name) + ": is no " + topic.ros_type());
  if (const std::string why = implausible(*message, member.told.id); !why.empty())
    return refuse(member, heard, std::string(topic.name) + ": " + why);
  if (!is_from_whom_we_believe(member, heard)) return {.is_refused = true};
  const ros::Time stamp = message->header.stamp;
  switch (member.clock.judge(seconds_of(stamp), heard.arrival)) {
    case ClockOffset::Verdict::plausible:
      break;
    case ClockOffset::Verdict::was_set:
      forget_times(member, heard.arrival);
      break;
    case ClockOffset::Verdict::too_old:
      return refuse(member, heard, std::string(topic.name) + ": is too old");
    case ClockOffset::Verdict::from_future:
      return refuse(member, heard, std::string(topic.name) + ": is from the future");
  }
  member.messages.add(heard.arrival, 1);
  member.bytes.add(heard.arrival, static_cast<double>(heard.data.size()));
  OfTopic& of_topic = member.topics[topic.name];
  std::deque<std::int64_t>& stamps = of_topic.stamps;
  const std::int64_t time = nanoseconds_of(stamp);
  const auto place = std::ranges::lower_bound(stamps, time);
  if (place != stamps.end() && *place == time) {
    ++counts_.repeated;
    return {};
  }
  ++member.heard;
  const Judgment believed{.believed = Believed{member.told.id, time, seconds_of(stamp) - *member.clock.ahead()}};
  const bool is_newest = place == stamps.end();
  stamps.insert(place, time);
  if (stamps.size() > kRemembered) stamps.pop_front();
  if (!is_newest) {
    ++counts_.late;
    note_late(member, seconds_of(stamp), heard.arrival);
    return believed;
  }
  member.late.reset();
  // What is late, or was heard before, is no sign of life: a link may bring it long after.
  if (heard.arrival - member.last_heard > options_.forget_s) tell(heard.arrival, member.told.id, "appeared");
  member.last_heard = std::max(member.last_heard, heard.arrival);
  of_topic.heard_at = heard.arrival;
  member.told.message_age = member.clock.delay(seconds_of(stamp), heard.arrival);
  member.told.scene.t = std::max(member.told.scene.t, believed.believed->t);
  keep(member, *message, heard.arrival);
  return believed;
}

/// A clock that was set back by less than messages may be late looks like that: all are older than those before, and as
/// late as each other.
void TeamView::note_late(Member& member, double stamp, double arrival) {
  constexpr int witnesses = 10;
  constexpr double testimony = 0.5, agree = 1;  // [s]
  const double apparent = arrival - stamp;
  if (!member.late || std::abs(apparent - member.late->apparent) > agree) member.late = Late{arrival, apparent, 0};
  if (++member.late->count < witnesses || arrival - member.late->first < testimony) return;
  member.clock = ClockOffset{};
  forget_times(member, arrival);
}

void TeamView::forget_times(Member& member, double arrival) {
  tell(arrival, member.told.id, "its clock was set");
  member.topics.clear();
  member.tallies.clear();
  member.late.reset();
  member.told.scene.t = 0;
}

void TeamView::keep(Member& member, const ros::PoseWithCovarianceStamped& message, double) {
  PoseSeen pose = pose_from(message);
  // Its state, which comes beside it, tells more of it.
  pose.kind = member.told.pose_kind.value_or(pose.kind);
  pose.age = member.told.pose_age.value_or(pose.age);
  pose.mirror = member.is_mirrored;
  member.told.scene.pose = pose;
}
void TeamView::keep(Member& member, const msgs::BallArray& message, double) {
  member.told.scene.balls = balls_from(message);
}
void TeamView::keep(Member& member, const msgs::GoalArray& message, double) {
  member.told.scene.goals = goals_from(message);
}
void TeamView::keep(Member& member, const msgs::RobotArray& message, double) {
  member.told.scene.robots = robots_from(message);
}
void TeamView::keep(Member& member, const msgs::LineArray& message, double) {
  member.told.scene.lines = lines_from(message);
  member.told.scene.circles = circles_from(message);
}
void TeamView::keep(Member& member, const msgs::TrackArray& message, double) {
  member.told.scene.tracks = tracks_from(message);
}
void TeamView::keep(Member& member, const msgs::FreeSpace& message, double) {
  member.told.scene.free_space = free_space_from(message);
}
void TeamView::keep(Member&, const ros::Odometry&, double) {}  // the pose says where it is

void TeamView::keep(Member& member, const msgs::TeamState& message, double arrival) {
  TeamMember& told = member.told;
  told.team = team_from(message.team);
  told.role = message.role;
  told.action = message.action;
  told.planning_state = message.planning_state;
  told.pose_kind = pose_kind_from(message.pose_kind);
  told.pose_age = told.pose_kind ? std::optional(message.pose_age) : std::nullopt;
  member.is_mirrored = message.pose_is_mirrored;
  if (!told.pose_kind) told.scene.pose.reset();
  if (told.scene.pose) add_state(*told.scene.pose, message);
  told.frame_rate = message.frame_rate;
  told.latency = message.latency;
  told.withheld = message.withheld;

  std::deque<Tally>& tallies = member.tallies;
  // This one is not among those it says were sent before.
  const Tally now{arrival, message.messages, member.heard - 1};
  if (!tallies.empty() && now.sent < tallies.back().sent) tallies.clear();
  tallies.push_back(now);
  while (tallies.size() > 2 && tallies[1].arrival <= arrival - kTallied) tallies.pop_front();
  const Tally& then = tallies.front();
  if (now.sent > then.sent)
    told.loss =
        std::clamp(1 - static_cast<double>(now.heard - then.heard) / static_cast<double>(now.sent - then.sent), 0., 1.);
}

TeamView::Judgment TeamView::refuse(Member& member, const Heard& heard, std::string why) {
  ++member.told.refused;
  if (heard.arrival - member.refused_at > kTroubleLasts)
    tell(heard.arrival, member.told.id, "sends what cannot be believed: " + why);
  member.refused_at = heard.arrival;
  member.refusal = std::move(why);
  return {.is_refused = true};
}

void TeamView::tell(double t, int robot, std::string text) {
  news_.push_back({++told_, t, robot, std::move(text)});
  if (news_.size() > kNews) news_.pop_front();
}

/// What happens while nothing comes.
void TeamView::watch(int id, Member& member, double now) {
  const double age = now - member.last_heard;
  const Presence presence = age > options_.gone_s    ? Presence::gone
                            : age > options_.stale_s ? Presence::stale
                                                     : Presence::here;
  if (presence != member.told.presence && age < options_.forget_s) {
    if (presence == Presence::gone) tell(now, id, "is gone: silent for " + with_digits(options_.gone_s, 0) + " s");
    if (presence == Presence::here && member.told.presence == Presence::gone) tell(now, id, "is back");
  }
  member.told.presence = presence;
  if (const auto ahead = member.clock.ahead(); ahead && presence == Presence::here) {
    const bool is_off = std::abs(*ahead) > options_.clock_tolerance_s;
    if (is_off && !member.is_announced_off) tell(now, id, clock_words(*ahead));
    member.is_announced_off = is_off;
  }
  if (member.is_announced_double && now - member.other_heard > kTroubleLasts) {
    tell(now, id, "has its number alone again");
    member.is_announced_double = false;
  }
}

TeamMember TeamView::described(const Member& member, double now) const {
  TeamMember told = member.told;
  told.age = std::max(0., now - std::max(member.last_heard, member.refused_at));
  const auto is_old = [&](const Topic& topic) {
    const auto at = member.topics.find(topic.name);
    return at == member.topics.end() || now - at->second.heard_at > options_.stale_s;
  };
  if (is_old(kBallsTopic)) told.scene.balls.clear();
  if (is_old(kGoalsTopic)) told.scene.goals.clear();
  if (is_old(kRobotsTopic)) told.scene.robots.clear();
  if (is_old(kTracksTopic)) told.scene.tracks.clear();
  if (is_old(kFreeSpaceTopic)) told.scene.free_space.reset();
  if (is_old(kLinesTopic)) {
    told.scene.lines.clear();
    told.scene.circles.clear();
  }
  told.messages_per_second = member.messages.per_second(now);
  told.bytes_per_second = member.bytes.per_second(now);
  told.clock_ahead = member.clock.ahead();
  if (now - member.other_heard < kTroubleLasts) told.troubles.emplace_back("two senders have its number");
  if (told.clock_ahead && std::abs(*told.clock_ahead) > options_.clock_tolerance_s)
    told.troubles.push_back(clock_words(*told.clock_ahead));
  if (now - member.refused_at < kTroubleLasts)
    told.troubles.push_back("sends what cannot be believed: " + member.refusal);
  return told;
}

TeamPicture TeamView::picture(double now) {
  TeamPicture picture;
  picture.t = now;
  for (auto& [id, member] : members_) watch(id, member, now);
  std::erase_if(members_, [&](const auto& entry) {
    const Member& member = entry.second;
    const double last = std::max({member.last_heard, member.refused_at, member.other_heard});
    return now - last > options_.forget_s;
  });
  for (const auto& [id, member] : members_) picture.members.push_back(described(member, now));
  picture.counts = counts_;
  picture.counts.bytes_per_second = bytes_.per_second(now);
  if (now - stranger_at_ < kTroubleLasts) picture.troubles.push_back("somebody unknown publishes " + stranger_);
  return picture;
}

}  // namespace tassilo
