#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tassilo/behavior/player.h"
#include "tassilo/sim/ideal_eyes.h"
#include "tassilo/sim/world.h"

namespace tassilo::test {

/// Who plays.
enum class Players {
  seeing,  ///< The players of `behavior`.
  black,   ///< The same, with black frames.
  blind,   ///< Drive about at random, as fast as they can.
  absent,
};

struct MatchOptions {
  std::uint64_t seed = 1;
  Players cyan = Players::seeing, magenta = Players::seeing;
  int each = 4;                ///< Robots of a team; the first one of each keeps the goal.
  double frame_rate = 20;      ///< [1/s]
  double latency = 0.05;       ///< From picture to wheels, less than between frames. [s]
  double team_latency = 0.15;  ///< Until mates hear of it. [s]
  EyesOptions eyes = {};
  WorldOptions world = {};
  bool is_told = true;  ///< Mates hear of one another.
};

/// What a player did, for looking at it.
struct Trace {
  double t = 0;
  SimState state;
  std::map<int, PlayerOutput> outputs;
};

/// A match without pictures: each robot has eyes and a player of its own, and hears what its mates tell.
class Match {
 public:
  Match(const FieldModel& field, const MatchOptions& options);

  /// One frame.
  void step();
  void play(double seconds);
  /// From now on others play, or the same in the dark.
  void set(Team team, Players players);

  World& world() { return world_; }
  const World& world() const { return world_; }
  const std::vector<RefereeEvent>& calls() const { return calls_; }
  const std::map<int, PlayerOutput>& outputs() const { return outputs_; }

 private:
  struct Seat {
    Team team = Team::cyan;
    Players kind = Players::seeing;
    PlayerOptions options;
    std::unique_ptr<IdealEyes> eyes;
    PlayerState state;
    std::mt19937 random;
    WheelCommand command;
  };
  /// What one tells the others.
  struct Word {
    double t = 0;
    int id = 0;
    Team team = Team::cyan;
    Teammate mate;
    std::optional<ToldBall> ball;
  };

  World world_;
  MatchOptions options_;
  std::map<int, Seat> seats_;
  std::deque<Word> words_;
  std::vector<RefereeEvent> calls_;
  std::map<int, PlayerOutput> outputs_;
};

/// Positions over time as a picture in SVG: one panel each `panel_s` seconds.
std::string svg_of(const std::vector<Trace>& traces, const World& world, double panel_s);

}  // namespace tassilo::test
