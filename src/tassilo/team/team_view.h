#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tassilo/message/topics.h"
#include "tassilo/scene/scene.h"
#include "tassilo/team/clock_offset.h"
#include "tassilo/team/rate_meter.h"

// What is known of the team from what came over the bus or out of a log, whoever sent it. Nothing here knows how
// messages travel: they may be lost, late, repeated, out of order, of wrong clocks or of nobody we know.

namespace tassilo {

/// A message as it came.
struct Heard {
  std::string_view topic;           ///< "/robot3/pose"
  std::string_view sender;          ///< Who published it, whatever robot it speaks of: the same as long as it runs.
  double arrival = 0;               ///< On our clock. [s since the UNIX epoch]
  std::span<const std::byte> data;  ///< CDR.
};

/// A message that is believed and was not heard before, late or not. Messages of one image have one stamp.
struct Believed {
  int robot = 0;
  std::int64_t stamp = 0;  ///< When its image was captured, on the robot's clock. [ns]
  double t = 0;            ///< The same on ours, later by what the quickest message of late took. [s]
};

struct TeamViewOptions {
  double stale_s = 1;                  ///< A robot that is silent for longer is stale. [s], > 0
  double gone_s = 5;                   ///< And gone. [s], > stale_s
  double forget_s = 60;                ///< And forgotten. [s], > gone_s
  double clock_tolerance_s = 1;        ///< A clock that is off by more is told of. [s], > 0
  std::vector<int> known_robots = {};  ///< Others are refused; empty: all of 0..255 are known.
  void check() const;                  ///< Throws Error naming the first field out of range.
};

enum class Presence { here, stale, gone };
std::string_view to_string(Presence presence);

/// What is known of one robot.
struct TeamMember {
  int id = 0;
  Team team = Team::unknown;
  Presence presence = Presence::here;
  double age = 0;  ///< Since anything came from it. [s]
  /// What it saw last, floor values in its frame, each list as it was told last and no older than stale_s, the pose
  /// however old. `t` is when the newest of it was captured, on our clock as far as that is known.
  Scene scene;
  std::optional<PoseKind> pose_kind;
  std::optional<double> pose_age;  ///< Since its last absolute fix. [s]
  std::string role, action, planning_state;
  double frame_rate = 0, latency = 0;  ///< As it says. [1/s, s]
  std::optional<double> message_age;   ///< Of the newest: how much longer it took than the quickest of late. [s]
  double messages_per_second = 0, bytes_per_second = 0;  ///< That came here.
  std::optional<double> loss;                            ///< Share of its messages that did not come lately. 0..1
  std::int64_t refused = 0;                              ///< In its name, but not believed.
  std::uint64_t withheld = 0;                            ///< Not sent for its budget, as it says.
  std::optional<double> clock_ahead;                     ///< Of ours, at least. [s]
  std::vector<std::string> troubles;                     ///< In words.
};

struct TeamCounts {
  std::int64_t heard = 0;     ///< All that came.
  std::int64_t refused = 0;   ///< Of them: no message, not to be believed, of no known robot, or by a second sender.
  std::int64_t late = 0;      ///< Of them: older than what was known.
  std::int64_t repeated = 0;  ///< Of them: known already.
  double bytes_per_second = 0;
};

struct TeamPicture {
  double t = 0;                     ///< When it is so, on our clock. [s]
  std::vector<TeamMember> members;  ///< By their number.
  std::vector<std::string> troubles;
  TeamCounts counts;
};

/// Something that happened, in words.
struct TeamNews {
  std::int64_t number = 0;  ///< 1, 2, ...
  double t = 0;             ///< On our clock. [s]
  int robot = -1;           ///< -1: none in particular.
  std::string text;
};

/// Listens, and knows. Memory is bounded whatever comes: by 256 robots, and by what one message may hold.
///
/// threads  one at a time
class TeamView {
 public:
  explicit TeamView(const TeamViewOptions& options = {});

  /// Takes a message. O(its size). Nothing when it is refused, repeated, or not kept by anybody who listens to robots
  /// (transforms, scans, pictures).
  std::optional<Believed> hear(const Heard& heard);
  /// What is known at this time, not before the last one. O(what is known).
  TeamPicture picture(double now);
  /// The newest, oldest first; at most kNews.
  const std::deque<TeamNews>& news() const { return news_; }
  static constexpr std::size_t kNews = 200;

 private:
  /// Messages sent and heard when a state told of it.
  struct Tally {
    double arrival = 0;
    std::uint64_t sent = 0, heard = 0;
  };
  /// What came on one topic.
  struct OfTopic {
    std::deque<std::int64_t> stamps;  ///< Of the last ones, rising. [ns]
    double heard_at = -1e9;           ///< Arrival of the newest.
  };
  struct Late {
    double first = 0;  ///< Arrival. [s]
    double apparent = 0;
    int count = 0;
  };
  struct Member {
    TeamMember told;
    std::string sender;         ///< Who is believed: the first one, until it is silent.
    double last_heard = -1e9;   ///< Arrival of what was believed.
    double other_heard = -1e9;  ///< When another one spoke in its name.
    ClockOffset clock;
    std::map<std::string_view, OfTopic> topics;
    std::uint64_t heard = 0;  ///< From this sender, once each.
    std::deque<Tally> tallies;
    RateMeter messages, bytes;
    double refused_at = -1e9, clock_refused_at = -1e9;
    std::string refusal;  ///< The last one, in words.
    bool is_announced_off = false, is_announced_double = false, is_mirrored = false;
    std::optional<Late> late;  ///< Those in a row that were older than the newest.
  };

  struct Judgment {
    bool is_refused = false;
    std::optional<Believed> believed = {};
  };

  Judgment hear_of_robot(const Heard& heard, const RobotTopic& topic);
  bool is_from_whom_we_believe(Member& member, const Heard& heard);
  template <Message M>
  Judgment take(Member& member, const Heard& heard, const Topic& topic);
  void keep(Member& member, const ros::PoseWithCovarianceStamped& message, double arrival);
  void keep(Member& member, const msgs::BallArray& message, double arrival);
  void keep(Member& member, const msgs::GoalArray& message, double arrival);
  void keep(Member& member, const msgs::RobotArray& message, double arrival);
  void keep(Member& member, const msgs::LineArray& message, double arrival);
  void keep(Member& member, const msgs::TrackArray& message, double arrival);
  void keep(Member& member, const msgs::FreeSpace& message, double arrival);
  void keep(Member& member, const msgs::TeamState& message, double arrival);
  void keep(Member& member, const ros::Odometry& message, double arrival);
  void note_late(Member& member, double stamp, double arrival);
  void forget_times(Member& member, double arrival);
  Judgment refuse(Member& member, const Heard& heard, std::string why);
  void tell(double t, int robot, std::string text);
  void watch(int id, Member& member, double now);
  TeamMember described(const Member& member, double now) const;

  TeamViewOptions options_;
  std::map<int, Member> members_;
  TeamCounts counts_;
  RateMeter bytes_;
  double stranger_at_ = -1e9;
  std::string stranger_;
  std::deque<TeamNews> news_;
  std::int64_t told_ = 0;
};

}  // namespace tassilo
