#pragma once

#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tassilo/app/configuration_watch.h"
#include "tassilo/app/match_air.h"
#include "tassilo/app/match_colors.h"
#include "tassilo/app/match_report.h"
#include "tassilo/app/team_sender.h"
#include "tassilo/behavior/player.h"
#include "tassilo/fusion/team_fusion.h"
#include "tassilo/sim/ideal_eyes.h"
#include "tassilo/sim/renderer.h"
#include "tassilo/sim/world.h"

namespace tassilo {

struct SimMatchOptions {
  FieldModel field;
  int robots = 4;                              ///< A team. 1..8
  double frame_rate = 20;                      ///< Images a second of each robot. [1/s], 5..60
  std::uint64_t seed = 1;                      ///< Of world, slip, noise, losses, opponents' eyes.
  GoalSide cyan_own_goal = GoalSide::minus_x;  ///< The goal that cyan defends.
  double opponents = 0.5;                      ///< How fast magenta drives, of cyan's speed. 0..1
  double loss = 0;                             ///< Share of what robots tell each other that is lost. 0..0.95
  double delay_s = 0.03;                       ///< How long the rest takes, in the mean. [s], 0..1
  bool is_dark = false;                        ///< Cyan's cameras show black.
  bool has_unrest = false;        ///< Robots leave and come back, and garbage is sent to those who play on.
  bool compares_radios = false;   ///< Also reports benches over air that loses and delays more and less.
  bool is_paced = true;           ///< Somebody lets it play as fast as time goes, or slower; else faster.
  std::optional<BusOptions> bus;  ///< Where cyan tells the world outside; nothing: nowhere.
  void check() const;             ///< Throws Error naming the first field out of range.
};

/// A match of two teams in one value: world, cameras, vision, team, players.
///
/// Cyan plays by what its cameras show: each robot's image is rendered, seen by the vision with colors that were
/// trained on rendered stills of this hall, told to the team as messages, combined, and played by; besides, its players
/// have the odometry of their wheels, and somebody who tells them where they are put at kick-offs. Magenta has eyes
/// without pictures, and nobody of it tells the others anything. Deterministic by seed but for the bus, which nobody in
/// it listens to.
///
/// threads  one at a time
class SimMatch {
 public:
  /// Trains the colors first, some seconds. Throws Error for options out of range.
  explicit SimMatch(const SimMatchOptions& options);
  SimMatch(const SimMatch&) = delete;
  SimMatch& operator=(const SimMatch&) = delete;

  /// One image of each robot, what comes of it, and the time until the next one. Throws Error when the bus is lost.
  void step();
  double t() const { return world_.state().t; }
  Score score() const { return world_.score(); }
  const World& world() const { return world_; }
  /// What the referee called since the last call of this.
  std::vector<RefereeEvent> take_calls() { return std::exchange(calls_, {}); }
  MatchReport report() const;
  /// Share of the stills' pixels that a table of the other stills classifies right.
  double colors_quality() const { return hall_.quality; }
  /// What went wrong with telling the world outside, in lines without ends.
  std::vector<std::string> news();

 private:
  struct Seat {
    int id = 0;
    std::shared_ptr<const Configuration> configuration;
    VisionWorkspace workspace;
    Odometry odometry;
    TeamFusion fusion;
    std::optional<TeamBall> team_ball;  ///< As it knows it with its newest image.
    TeamFusion alone;                   ///< Of its own images only, to compare with.
    bool sees_ball = false;
    std::map<int, Teammate> mates;
    std::map<int, double> heard_at;  ///< [s]
    PlayerOptions player;
    PlayerState state;
    WheelCommand command;
    std::unique_ptr<TeamSender> sender;
    std::optional<double> lost_since;  ///< [s]
  };
  struct Opponent {
    std::unique_ptr<IdealEyes> eyes;
    PlayerOptions player;
    PlayerState state;
    WheelCommand command;
  };
  /// Somebody beside the field who hears what all tell.
  struct Bench {
    MatchAir air;
    TeamFusion fusion;
    BallKnowledge* figures = nullptr;  ///< In the report.
  };
  struct Absence {
    int id = 0;
    double until = 0;  ///< [s]
  };

  int any_of_team();
  bool is_goalkeeper(int id) const;
  void seat_cyan(int id);
  void seat_magenta(int id);
  void place_by_hand(Seat& seat);
  void let_leave_and_come_back(double now);
  void see_and_play(Seat& seat);
  void tell(const Seat& seat, const Scene& scene, Role role);
  void keep_clock(double now);
  void send_garbage(double now, int robot, const std::shared_ptr<const TeamPacket>& packet);
  void hear(double now);
  void count(Contribution contribution);
  void play(int id, Opponent& opponent);
  void go_on(double seconds);
  void note(Seat& seat, const Scene& scene);
  void note_balls(double t);

  const SimMatchOptions options_;
  World world_;
  CameraModel camera_;
  CameraMount mount_;
  Renderer renderer_;
  TrainedHall hall_;
  std::map<int, Seat> seats_;
  std::map<int, Opponent> opponents_;
  MatchAir air_;
  std::vector<Bench> benches_;
  std::mt19937_64 random_;
  std::optional<Absence> absence_;
  double next_absence_ = 0;  ///< [s]
  double clock_ = 0;         ///< Of the world outside, by the time of the match. [s]
  std::vector<RefereeEvent> calls_;
  double called_at_ = -1e9;  ///< By the referee, at last. [s]
  std::int64_t frame_ = 0;
  MatchReport report_;
};

}  // namespace tassilo
