#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "tassilo/base/recycled.h"
#include "tassilo/fusion/team_observation.h"
#include "tassilo/geometry/point.h"
#include "tassilo/scene/scene.h"

// Ball and opponents as all robots of the team see them together. docs/decisions/0022 tells why it is done so.

namespace tassilo {

/// How things move, what is believed of poses and sightings, and what is remembered. One standard deviation along each
/// axis where it says sigma.
struct TeamFusionOptions {
  /// Color of the own robots' markers: robots seen in it are no opponents. Unknown: markers tell nothing of that.
  Team own_team = Team::unknown;

  double ball_friction = 0.35;  ///< Braking of a ball that rolls on carpet, 3 to 5 % of gravity. [m/s^2], >= 0
  /// Change of velocity within a second that is nobody's kick: carpet, touches. It grows with the root of time.
  /// [m/s/sqrt(s)], > 0
  double ball_acceleration = 0.3;
  double robot_acceleration = 1;  ///< Likewise of robots, which drive as they like. [m/s/sqrt(s)], > 0
  double ball_speed = 1;          ///< Sigma of the velocity of a ball just found. [m/s], > 0
  double robot_speed = 0.7;       ///< Of a robot just found. [m/s], > 0
  double kick_speed = 2.5;        ///< Sigma of the change of velocity by a kick or a wall. [m/s], >= 0
  double kick_rate = 0.6;         ///< Kicks per second; 0: none. [1/s], >= 0
  double kick_duration = 0.2;     ///< How long the velocity goes on changing. [s], > 0

  /// Time in which the correlation of a pose's error with itself falls to 1/e: as long as the same lines are in view.
  /// [s], > 0
  double pose_memory = 2;
  double max_pose_age = 3;         ///< Since the pose's last absolute fix; an older one is not used. [s], >= 0
  double max_pose_sigma = 1;       ///< A pose less certain in any direction is not used. [m], > 0
  double max_heading_sigma = 0.3;  ///< Or in its heading: levers are taken for straight lines. [rad], > 0
  double robot_width = 0.45;       ///< Of a robot in full view. [m], > 0
  double robot_common = 0.04;      ///< A robot's middle is told from what shows of its outline. Sigma, [m], >= 0

  double gate = 13.8;         ///< Squared Mahalanobis distance of a sighting that belongs to a thing: 99.9 %. [1], > 0
  double support = 2.2;       ///< A thing is told when the confidences of its sightings, 1 of robots, add to it. > 0
  double confirm_time = 0.5;  ///< Until it is told it must be seen again so soon. [s], > 0
  int misses = 4;             ///< And is given up when those who saw it miss it so often in a row. >= 1
  double max_age = 2;         ///< Kept so long without being seen by anybody. [s], >= confirm_time
  double max_ball_sigma = 2;  ///< A place less certain than this in any direction is none. [m], > 0
  double max_robot_sigma = 1.5;  ///< Likewise of robots. [m], > 0
  int max_balls = 6;             ///< Hypotheses. >= 1
  int max_opponents = 16;        ///< >= 1

  /// What comes later than this after its capture is dropped: as long as messages may be delayed. [s], > 0
  double history = 1;
  double ahead = 0.2;          ///< An observation from so far in the future is of a wrong clock. [s], >= 0
  int max_observations = 512;  ///< Of so many the history consists at most; 10 robots, 30 a second, 1 s. >= 16
  void check() const;          ///< Throws Error naming the first field out of range.
};

/// A ball or an opponent as the team knows it.
struct TeamThing {
  int id = 0;  ///< > 0; the same as long as it is followed, unless something late changes what was thought of the past.
  Gaussian2<FieldFrame> position;                            ///< Floor point of a ball, middle of a robot.
  double vx = 0, vy = 0;                                     ///< Over the field. [m/s]
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();  ///< Of x, y, vx, vy.
  double age = 0;                                            ///< Since anybody saw it last. [s]
  RecycledVector<int> robots;                                ///< Who saw it within max_age, by number; the last ten.
};
struct TeamBall : TeamThing {
  double weight = 0;  ///< Confidences of its sightings, fading within a second.
};
struct TeamOpponent : TeamThing {
  Team team = Team::unknown;  ///< By most of its sightings.
};

/// What the team knows at one time.
struct TeamWorld {
  double t = 0;                            ///< [s]
  std::optional<TeamBall> ball;            ///< The one most seen lately; none while nobody saw one for max_age.
  RecycledVector<TeamBall> other_balls;    ///< Other places where it may be, most seen first.
  RecycledVector<TeamOpponent> opponents;  ///< By id; robots that are not known to be teammates.
};

/// Where an observation went.
enum class Contribution {
  taken,
  duplicate,  ///< Nowhere: that image of that robot is known.
  too_late,   ///< Nowhere: it is older than the history.
  refused,    ///< Nowhere: of a time that is no time, or of the future.
};
/// All that came.
struct TeamFusionCounts {
  std::int64_t taken = 0, duplicates = 0, too_late = 0, refused = 0;
  std::int64_t out_of_order = 0;  ///< Of those taken: older than what had come.
  std::int64_t without_pose = 0;  ///< Of those taken: no pose, a mirrored, old or vague one; nothing is known by them.
  std::int64_t replayed = 0;      ///< Observations processed anew because something had come late.
};

/// Combines what all robots see, on each robot and at the bench alike.
///
/// The result is that of all observations in the order of their capture, in whatever order they came and however often:
/// what comes late is put in its place, and what is younger is reckoned again from the last state kept before it. It
/// is the same to the bit as long as none comes too late.
///
/// Each thing is followed by a Kalman filter over place and velocity, and over the pose errors of the robots that saw
/// it: those persist from image to image, and who errs alike all the time is not believed more for saying so often. A
/// ball rolls or has just been kicked: two such filters, mixed (IMM). Sightings go to things as likely as possible all
/// together; those of teammates, whose poses are known, to them.
///
/// source   estimated biases of first-order Markov kind: B. Friedland, IEEE Trans. AC 14, 1969, and Y. Bar-Shalom, X.
/// R.
///          Li, T. Kirubarajan, "Estimation with applications to tracking and navigation", 2001, ch. 8; IMM: H. A. P.
///          Blom, Y. Bar-Shalom, IEEE Trans. AC 33, 1988; late observations by doing it again, no approximation: own
/// threads  one at a time
class TeamFusion {
 public:
  /// Throws Error for options out of range.
  explicit TeamFusion(const TeamFusionOptions& options = {});
  ~TeamFusion();
  TeamFusion(TeamFusion&&) noexcept;
  TeamFusion& operator=(TeamFusion&&) noexcept;

  /// Takes an observation that came at `now` on our clock. Reckons nothing yet. O(observations in the history).
  /// Numbers in it that cannot be (not finite, a kilometer away, covariances that are none) make that sighting or pose
  /// unknown, nothing else.
  Contribution add(const TeamObservation& observation, double now);

  /// What the team knows at t: by the observations up to t, from then on by prediction. Of a time before the history
  /// nothing is known any more. Some 5 us, or 10 with ten robots, for each observation that is new or younger than what
  /// came late; no memory is allocated once the usual number of things was seen.
  TeamWorld at(double t);

  const TeamFusionCounts& counts() const;
  std::size_t size() const;  ///< Observations in the history.

 private:
  struct History;
  std::unique_ptr<History> history_;
};

}  // namespace tassilo
