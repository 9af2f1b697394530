#pragma once

#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tassilo/app/configuration_watch.h"
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
  double loss = 0;                             ///< Share of what robots tell each other that is lost. 0..0.95
  double delay_s = 0.03;                       ///< How long the rest takes, in the mean. [s], 0..1
  bool is_dark = false;                        ///< Cyan's cameras show black, from the kick-off on.
  std::optional<BusOptions> bus;               ///< Where cyan tells the world outside; nothing: nowhere.
  void check() const;                          ///< Throws Error naming the first field out of range.
};

/// How good what was seen and known was, against what is true.
struct SimMatchReport {
  double seconds = 0;
  Score score;
  std::int64_t images = 0;
  std::vector<double> ball_errors;  ///< Of balls that robots saw: on the floor. [m]
  std::vector<double> pose_errors;  ///< Of poses. [m]
  double longest_lost = 0;          ///< Without a pose within half a metre of the truth, one robot. [s]
  std::vector<double> team_errors;  ///< Of the team's ball, while at least one robot sees it. [m]
  std::vector<double> best_errors;  ///< Of the single robot's that is surest at the same moments. [m]
  std::int64_t seen = 0,
               known = 0;    ///< Moments with at least one robot that sees the ball, and those with a team ball.
  std::vector<double> nees;  ///< Squared error of the team's ball by its covariance; 2 in the mean.
};

/// A match of two teams in one value: world, cameras, vision, team, players.
///
/// Cyan plays by what its cameras show: each robot's image is rendered, seen by the vision with colors that were
/// trained on rendered stills of this hall, told to the team as messages, combined, and played by; nothing else reaches
/// its players. Magenta has eyes without pictures. Deterministic by seed but for the bus, which nobody in it listens
/// to.
///
/// threads  one at a time
class SimMatch {
 public:
  /// Trains the colors first, some seconds. Throws Error for options out of range.
  explicit SimMatch(const SimMatchOptions& options);

  /// One image of each robot, what comes of it, and the time until the next one.
  void step();
  double t() const { return world_.state().t; }
  Score score() const { return world_.score(); }
  const World& world() const { return world_; }
  const std::vector<RefereeEvent>& calls() const { return calls_; }
  const SimMatchReport& report() const { return report_; }
  /// Share of the stills' pixels that a table of the other stills classifies right.
  double colors_quality() const { return colors_quality_; }
  /// What went wrong with telling the world outside, in lines without ends.
  std::vector<std::string> news();

 private:
  /// What a robot told its team with one image.
  struct Word {
    TeamObservation observation;
    Role role = Role::defender;
  };
  /// It on its way to one of them.
  struct Packet {
    double due = 0;  ///< [s]
    int to = 0;
    std::shared_ptr<const Word> word;
  };
  struct Seat {
    int id = 0;
    std::shared_ptr<const Configuration> configuration;
    VisionWorkspace workspace;
    Odometry odometry;
    TeamFusion fusion;
    std::map<int, Teammate> mates;
    std::map<int, double> heard_at;
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

  void train_colors();
  void seat_cyan(int id, bool is_goalkeeper);
  void seat_magenta(int id, bool is_goalkeeper);
  void see_and_play(Seat& seat);
  void tell(Seat& seat, const Scene& scene, const PlayerOutput& output);
  static Word word_of(int robot, const Scene& scene, const PlayerOutput& output);
  void hear(double now);
  void play(int id, Opponent& opponent);
  void go_on(double seconds);
  void note(Seat& seat, const Scene& scene);
  void note_team(double t);

  const SimMatchOptions options_;
  World world_;
  CameraModel camera_;
  CameraMount mount_;
  Renderer renderer_;
  ColorTable colors_;
  double colors_quality_ = 0;
  std::map<int, Seat> seats_;
  std::map<int, Opponent> opponents_;
  TeamFusion bench_;
  /// Of the ball, by one robot at this moment.
  struct Sighting {
    double variance = 0;  ///< By its own account. [m^2]
    double error = 0;     ///< On the field, with the robot's own pose. [m]
  };
  std::vector<Sighting> sightings_;
  std::vector<Packet> air_;
  std::mt19937_64 random_;
  std::vector<RefereeEvent> calls_;
  std::int64_t frame_ = 0;
  SimMatchReport report_;
};

}  // namespace tassilo
