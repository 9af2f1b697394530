#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "tassilo/fusion/team_fusion.h"
#include "tassilo/message/tassilo_messages.h"
#include "tassilo/team/team_view.h"

namespace tassilo {

/// Ball and opponents as all robots see them together, from what TeamView believes: the bench hears everybody and has
/// eyes of its own nowhere.
///
/// An image's messages belong together by robot and stamp, and by nothing else: where a robot stood in another image
/// says nothing of this one's ball. What is late, lost or out of order is what TeamFusion is made for.
///
/// All who talk are heard as one team, since there is one ball. While they tell one color, robots seen in it are no
/// opponents; when they tell several, as when both teams of a training match are watched, a marker tells nothing, and
/// only those whom nobody's pose explains are opponents. When what is told of colors changes, what was seen more than a
/// second ago is forgotten, and numbers of things begin anew.
///
/// Memory is bounded, whatever comes. threads  one at a time
class TeamBench {
 public:
  /// Of the options, own_team is found out. Throws Error for those out of range.
  explicit TeamBench(const TeamFusionOptions& options = {});

  /// Takes what TeamView made of the message. O(its size + images of the last second).
  void hear(const Heard& heard, const Believed& believed);
  /// What the team knows at this time, field frame; nothing when nobody knows. Times grow. Some 5 to
  /// 10 us for each image since the last one.
  TeamWorld at(double now);

 private:
  /// Robot and stamp.
  using Key = std::pair<int, std::int64_t>;
  struct Image {
    double heard_at = 0;  ///< Arrival of the first of its messages. [s]
    double t = 0;         ///< [s]
    std::optional<PoseSeen> pose;
    std::optional<RecycledVector<Ball>> balls;
    std::optional<RecycledVector<RobotSeen>> robots;
    std::optional<msgs::TeamState> state;
    bool is_given = false;
  };
  /// What a robot said last of itself.
  struct Voice {
    msgs::TeamState state;
    double told_at = 0;  ///< [s]
  };

  void give(const Key& key, Image& image, double now);
  void give_due(double now);
  void forget(std::size_t at);
  void ask_color(double now);

  TeamFusionOptions options_;
  TeamFusion fusion_;
  std::map<int, Voice> voices_;
  std::map<Key, Image> images_;
  std::deque<Key> order_;               ///< Of `images_`, as they were first heard of.
  std::map<int, std::size_t> waiting_;  ///< Of each robot, of `images_`; none is 0.
  std::size_t due_ = 0;                 ///< So many of them, the oldest, wait for no other message.
  std::deque<TeamObservation> recent_;  ///< Given, of the history: a fusion that begins anew needs them.
  double asked_at_ = -1e9;
};

}  // namespace tassilo
