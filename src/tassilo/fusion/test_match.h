#pragma once

#include <vector>

#include "tassilo/fusion/team_fusion.h"
#include "tassilo/fusion/team_observation.h"

// A made-up match, without images: a ball that is kicked, rolls and bounces, four robots that look about, four
// opponents; what the robots see, with all its errors, and how it travels. And how good what the team makes of it is.

namespace tassilo::test {

struct MatchOptions {
  unsigned seed = 1;
  double duration = 40;                              ///< [s]
  double rate = 30;                                  ///< Images of each robot. [1/s]
  double pose_memory = 2;                            ///< Correlation time of pose errors. [s]
  double pose_sigma = 0.05, heading_sigma = 0.0436;  ///< Of pose errors. [m, rad]
  double claimed = 1;                                ///< What robots claim these to be, as a multiple.
  double kick_rate = 0.35;                           ///< [1/s]
  double false_balls = 0.01;                         ///< Share of images in which one begins, to last some images. 0..1
  double detection = 0.9;                            ///< Share of images that show a ball in view. 0..1
};

/// How it is, at some time.
struct Moment {
  double t = 0;
  FieldPoint ball;
  double vx = 0, vy = 0;
  std::vector<FieldPoint> opponents;
  std::vector<char> sees_ball;        ///< Of each robot: in view, near enough, and not hidden.
  std::vector<double> opponent_seen;  ///< When any robot had each opponent in view last. [s]
};

struct Match {
  std::vector<Moment> moments;                ///< By time, ten a second.
  std::vector<TeamObservation> observations;  ///< By time; robots 0..3, in cyan.
};
Match play(const MatchOptions& options);

/// Loses messages, and delays the others by `delay` * (0.5..1.5).
struct Radio {
  double loss = 0, delay = 0;  ///< [1], [s]
  unsigned seed = 1;
};

/// What somebody has of the ball and the opponents at one moment.
struct Answer {
  double t = 0;
  bool visible = false;    ///< Does any robot see the ball?
  bool own_sight = false;  ///< Does the one who answers?
  bool has_ball = false;
  double error = 0;                           ///< Of the ball's place. [m]
  double squared = 0;                         ///< Normalized squared error; 2 in the mean.
  double sigma = 0;                           ///< Root of the covariance's trace. [m]
  double age = 0;                             ///< [s]
  int opponents = 0, missed = 0, ghosts = 0;  ///< Seen by anybody within a second; of them unknown; told, but nobody.
  std::vector<double> opponent_errors, opponent_squared;
};

/// Who answers: a robot has its own observations at once and those of the others by radio, the bench all by radio.
inline constexpr int kBench = -1;
std::vector<Answer> answers_of_team(const Match& match, const Radio& radio, int who, TeamFusionOptions options = {});
/// Of one robot that hears nobody, by the same filter.
std::vector<Answer> answers_alone(const Match& match, int robot, TeamFusionOptions options = {});
/// At each moment those of the robot that is surest of its ball then, each alone.
std::vector<Answer> answers_of_surest(const std::vector<std::vector<Answer>>& alone);
/// The bare sighting of the robot that sees best at that moment, by the covariance it claims.
std::vector<Answer> answers_of_best_sighting(const Match& match);

/// Figures over moments in which any robot sees the ball.
struct Figures {
  double available = 0;           ///< Share of them with a ball.
  double median = 0, ninety = 0;  ///< Of the error. [m]
  double squared = 0;             ///< Mean normalized squared error; 2 is exact.
  double squared_median = 0;      ///< Its median; 1.39 is exact. A ball that is none does not hide the rest in it.
  double outside = 0;             ///< Share beyond 9.21, which 1 % should be.
  double mean = 0;                ///< Of the error, for one number of all. [m]
  double opponents_missed = 0,
         ghosts = 0;  ///< Share of those seen within a second; told ones that are nobody, a moment.
  double opponent_median = 0, opponent_squared = 0;
};
Figures figures_of(const std::vector<Answer>& answers);

}  // namespace tassilo::test
