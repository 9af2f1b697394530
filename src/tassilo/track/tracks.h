#pragma once

#include <Eigen/Core>
#include <span>

#include "tassilo/base/recycled.h"
#include "tassilo/camera/mount.h"
#include "tassilo/scene/scene.h"
#include "tassilo/timeline/robot_motion.h"

namespace tassilo {

/// How objects move and what is believed of a sighting. One standard deviation along each axis where it says sigma.
struct TrackOptions {
  /// Change of velocity within a second that is nobody's kick: carpet, wheels, touches. Random; it grows with the root
  /// of time. [m/s/sqrt(s)], > 0
  double ball_acceleration = 0.4;
  double robot_acceleration = 0.5;
  double ball_speed = 1;     ///< Sigma of the velocity of a ball just found. [m/s], > 0
  double robot_speed = 0.5;  ///< Of a robot just found. [m/s], > 0
  double kick_speed = 4;     ///< Sigma of the change of velocity by a kick; 0: none is reckoned with. [m/s], >= 0
  /// Share of a ball's place that all frames have wrong alike (its radius, the mount), relative to its distance. Sigma,
  /// [1], >= 0
  double ball_common = 0.002;
  double robot_width = 0.45;   ///< Of a robot in full view. [m], > 0
  double robot_common = 0.04;  ///< A robot's middle is told from what shows of its outline. Sigma, [m], >= 0
  double gate = 13.8;          ///< Squared Mahalanobis distance of a sighting that belongs to a track: 99.9 %. [1], > 0
  double sure_ball = 0.3;      ///< A ball of this confidence is told at once while there is no other. 0..1
  int sightings = 3;           ///< Anything else is told after so many. >= 1
  double max_age = 1;          ///< Kept so long without being seen. [s], > 0
  double max_sigma = 1;        ///< A place less certain than this in any direction is none. [m], > 0
  int clear_misses = 3;  ///< Given up when the floor where it should be was seen free in so many frames in a row. >= 1
  int max_tracks = 32;   ///< >= 1
  void check() const;    ///< Throws Error naming the first field out of range.
};

/// One object followed over time.
struct Track {
  int id = 0;  ///< 0 until it is sure enough to be told, then > 0 for good.
  TrackKind kind = TrackKind::ball;
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();  ///< x y vx vy, as in TrackSeen. [m, m/s]
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
  double seen_at = 0;         ///< [s]
  int sightings = 0;          ///< Frames in which it was seen.
  int clear_misses = 0;       ///< Frames in a row in which it should have been seen; before it is told, any frame.
  int cyan = 0, magenta = 0;  ///< Sightings as such.

  Team team() const { return cyan > magenta ? Team::cyan : magenta > cyan ? Team::magenta : Team::unknown; }
};

/// What is known of the objects around the robot at one time, in the robot's frame at that time. A value: the next one
/// follows from it, and it may be kept, copied and continued in several ways.
struct TrackState {
  double t = 0;                  ///< [s]
  RecycledVector<Track> tracks;  ///< Oldest first; at most max_tracks.
  int next_id = 1;
  /// Of the robot's own velocity, forward, left and turning, where no odometry tells it: then the velocity of all
  /// objects is wrong by it alike. Zero with odometry. [m/s, rad/s]
  Eigen::Matrix3d own_velocity_covariance = Eigen::Matrix3d::Zero();
};

/// What one frame shows of them. Without floor values an object is passed over.
struct TrackObservation {
  std::span<const Ball> balls;
  std::span<const RobotSeen> robots;
  /// Both together say what should have been seen; null: an object not seen may always be hidden.
  const FreeSpace* free_space = nullptr;
  const MountedCamera* camera = nullptr;
};

/// The same objects at another time, nothing seen in between: they roll on while the robot moves. Those not seen for
/// too long, or no longer anywhere in particular, are gone.
///
/// motion   of the robot from before.t to t
/// t        not before before.t, else no time passes
TrackState predicted(const TrackState& before, const RobotMotion& motion, double t, const TrackOptions& options);

/// The objects at time t from those before, the robot's motion between and what is seen at t.
///
/// Each object has a velocity over the floor that changes at random; its place and velocity are estimated together by a
/// Kalman filter in the robot's frame, which needs no pose and lets the robot's motion count as exactly as odometry
/// knows it. Sightings go to the tracks that make them likeliest, all together; a cyan robot is hardly a magenta one. A
/// ball that no track explains is the one known ball kicked, if a kick could bring it there. What is left begins a
/// track. A track ends by max_age, max_sigma and clear_misses, and where another body of its kind is seen in its place.
///
/// seen     in any order: the result does not depend on it
/// cost     some us a track, O(max_tracks^3) at worst; allocates from recycled memory only; safe from any thread
/// source   global nearest neighbour, white-noise acceleration: Y. Bar-Shalom, X. R. Li, T. Kirubarajan, "Estimation
///          with applications to tracking and navigation", 2001, ch. 6; kicks and clear view: own
TrackState track(const TrackState& before, const RobotMotion& motion, const TrackObservation& seen, double t,
                 const TrackOptions& options);

/// What may be told to others: balls first, most often seen first; then robots by id.
RecycledVector<TrackSeen> told(const TrackState& state, const TrackOptions& options);

}  // namespace tassilo
