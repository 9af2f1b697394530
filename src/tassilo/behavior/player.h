#pragma once

#include <optional>
#include <span>
#include <string>

#include "tassilo/behavior/roles.h"
#include "tassilo/behavior/wheel_command.h"
#include "tassilo/field/field_model.h"
#include "tassilo/geometry/pose2.h"
#include "tassilo/scene/scene.h"

// A player: from what a robot's own vision sees and what its team tells to what its wheels do. It knows nothing else.
// To add a skill: 1. a function in internal/skills.h that says where to drive, 2. its place in play() in player.cpp,
// which is read from top to bottom, 3. its words for the monitor there, 4. a law in player_test.cpp.

namespace tassilo {

/// The robot, and how it is played. Lengths that scale with the robot are in robot radii.
struct PlayerOptions {
  bool is_goalkeeper = false;
  double radius = 0.225;           ///< Of the robot. [m], > 0
  double wheel_base = 0.36;        ///< Between its wheels. [m], > 0
  double max_speed = 1;            ///< Of a wheel. [m/s], > 0
  double acceleration = 1.5;       ///< That its wheels surely reach, also when they brake. [m/s^2], > 0
  double max_turn_rate = 2.5;      ///< Pictures still tell something while it turns so fast. [rad/s], > 0
  double dribble_turn_rate = 1.2;  ///< The ball stays before a robot that turns no faster. [rad/s], > 0
  double dribble_speed = 1;        ///< [m/s], > 0
  double kick_reach = 0.05;        ///< A kick reaches the ball over such a gap. [m], >= 0
  double kick_deg = 20;            ///< The ball is before the robot when no further from ahead. [deg], > 0
  double ball_friction = 0.4;      ///< Of a rolling ball. [m/s^2], > 0
  double margin = 0.35;            ///< Kept free beside the robot where there is room. [radii], >= 0
  double max_pose_age = 4;         ///< A pose without a fix for longer is none. [s], > 0
  double max_team_age = 2;         ///< What mates told longer ago is not known. [s], > 0
  double role_hold_s = 0.4;  ///< Another role must be the better one for so long: longer than words travel. [s], >= 0
  double stuck_way = 1;      ///< Wheels that drove so far while it did not get on: it is stuck. [m], > 0
  RoleOptions roles;
  void check() const;  ///< Throws Error naming the first field out of range.
};

/// For robots of the size that a field's file says.
PlayerOptions player_options(const FieldModel& field);

/// The side on which the goal of a color stands; missing: the field has none of it.
std::optional<GoalSide> side_of_goal(const FieldModel& field, GoalColor color);

/// Where the team says that the ball is.
struct ToldBall {
  Gaussian2<FieldFrame> position;
  double vx = 0, vy = 0;  ///< Field frame. [m/s]
  double age = 0;         ///< Since one of the team saw it. [s]
};

/// What another robot of the team tells of itself.
struct Teammate {
  int id = 0;
  bool is_goalkeeper = false;
  std::optional<FieldFromRobot> pose;  ///< Missing: it does not know.
  std::optional<Role> role;            ///< Missing: it has not told yet.
  double age = 0;                      ///< Since it told this. [s]
};

/// All that a player knows.
struct PlayerInput {
  int id = 0;
  Team team = Team::unknown;              ///< Its own.
  GoalSide own_goal = GoalSide::minus_x;  ///< The goal it defends.
  double t = 0;                           ///< Now, on the scene's clock; the scene is older. [s]
  const Scene* scene = nullptr;           ///< The newest of its own vision; null: none yet.
  const FieldModel* field = nullptr;      ///< Never null.
  std::optional<ToldBall> ball;           ///< Missing: nobody knows.
  std::span<const Teammate> mates;
};

/// What a player keeps from one picture to the next. A value: it may be kept, copied and continued in several ways.
struct PlayerState {
  double t = -1e9;                         ///< Of the last step. [s]
  double speed = 0, turn_rate = 0;         ///< As the wheels should do it by now. [m/s, rad/s]
  std::optional<Assignment> role;          ///< Missing: none yet.
  std::optional<double> other_role_since;  ///< Since when another one would be better. [s]
  std::optional<double> way;               ///< Direction last chosen around something, robot frame. [rad]
  double aim = 0;                          ///< Where in the other goal's mouth, of its half width. -1..1
  std::optional<FieldPoint> ball_was_at;   ///< When it was last known.
  double ball_known_at = -1e9;             ///< [s]
  std::optional<double> searches_since;    ///< [s]
  double search_side = 1;                  ///< To which side it looks around: 1 left, -1 right.
  std::optional<double> has_ball_since;    ///< [s]
  bool is_in_place = false;                ///< It has reached where it wants to stand.
  std::optional<FieldPoint> started_from;  ///< Where it last got on.
  double driven = 0;                       ///< By its wheels, since then. [m]
  double backs_until = -1e9;               ///< Backs out of where it is stuck. [s]
  int times_stuck = 0;
};

/// What it does, and in words for the monitor.
struct PlayerOutput {
  WheelCommand wheels;
  Role role = Role::defender;
  std::string action;  ///< search, go_to_ball, dribble, shoot, defend, keep_goal, clear, avoid, recover, localize
  std::string planning_state;  ///< The next thing it waits for, in some words.
};

struct PlayerStep {
  PlayerState state;
  PlayerOutput output;
};

/// One step of a player: once for every new scene, and whenever a command would get old.
///
/// Without a floor that was seen free it does not drive on, without a ball that anyone saw there is none to go to:
/// what sees nothing turns on the spot.
///
/// input.t   not before that of the state, else no time passes
/// cost      some 10 us; safe from any thread
/// source    own; speeds from what is free as in S. Thrun et al. "The dynamic window approach", 1997, much simplified
PlayerStep play(const PlayerState& before, const PlayerInput& input, const PlayerOptions& options);

}  // namespace tassilo
