#pragma once

#include <optional>
#include <vector>

#include "tassilo/behavior/player.h"
#include "tassilo/field/field_curves.h"
#include "tassilo/geometry/point.h"

namespace tassilo {

/// Another robot, robot frame.
struct OtherRobot {
  FloorPoint at;
  double radius = 0;  ///< [m]
  bool is_mate = false;
};

/// One direction in which floor was seen.
struct SeenFloor {
  FloorPoint end;           ///< What is nearer is free.
  bool is_blocked = false;  ///< Something stands there; else it is not known what is behind.
};

/// All that is known, brought to the robot's frame now: what was seen is as old as the picture, and the robot has
/// driven on since.
struct Situation {
  double t = 0;
  double ball_radius = 0;              ///< [m]
  std::optional<FieldFromRobot> pose;  ///< Missing: where it is is not known well enough to act on.
  std::optional<FloorPoint> ball;      ///< Missing: nobody knows.
  FloorPoint ball_velocity;            ///< Over the floor. [m/s]
  double ball_age = 0;                 ///< Since anyone saw it. [s]
  bool is_ball_seen = false;           ///< By its own vision.
  bool is_ball_remembered = false;     ///< By nobody now.
  std::vector<OtherRobot> others;
  std::vector<SeenFloor> floor;
  FieldExtent arena;                    ///< Where a robot's middle may be. [m]
  FieldPoint own_goal, other_goal;      ///< Middles of the goal lines; of the field's ends where no goals are.
  double goal_half_width = 0;           ///< [m]
  std::optional<FloorPoint> goal_seen;  ///< The other one's mouth.

  FloorPoint in_robot(FieldPoint p) const { return inverse(*pose) * p; }
  FieldPoint in_field(FloorPoint p) const { return *pose * p; }
  bool is_on_field(FieldPoint p) const {
    return p.x >= arena.x.low && p.x <= arena.x.high && p.y >= arena.y.low && p.y <= arena.y.high;
  }
  FieldPoint clamped(FieldPoint p) const;
};

Situation situation(const PlayerState& before, const PlayerInput& input, const PlayerOptions& options);

/// Where a rolling ball is after some time, as friction lets it.
FloorPoint rolled(FloorPoint ball, FloorPoint velocity, double dt, double friction);

}  // namespace tassilo
