#pragma once

#include <algorithm>
#include <vector>

#include "tassilo/geometry/point.h"
#include "tassilo/geometry/pose2.h"
#include "tassilo/scene/scene.h"

namespace tassilo {

/// A ball of the simulated world. Field frame.
struct SimBall {
  FieldPoint at;          ///< Below its centre. [m]
  double vx = 0, vy = 0;  ///< [m/s]
  double radius = 0.105;  ///< [m]
};

/// A robot of the simulated world: an upright cylinder with two driven wheels. Field frame.
struct SimRobot {
  int id = 0;                  ///< 0..255, unique among all of both teams.
  Team team = Team::cyan;      ///< Color of its marker.
  FieldPoint at;               ///< Its middle on the floor. [m]
  double theta = 0;            ///< Heading. [rad]
  double speed = 0, turn = 0;  ///< Along its heading and about the vertical, as it really moves. [m/s, rad/s]
  double radius = 0.2;         ///< [m]
  double height = 0.5;         ///< [m]
};

/// All that moves in the simulated world at one time: what the renderer draws and what truth is.
struct SimState {
  double t = 0;  ///< Since the match began. [s]
  SimBall ball;
  std::vector<SimRobot> robots;  ///< By id.
};

/// Null where there is none of this id.
inline const SimRobot* find_robot(const SimState& state, int id) {
  const auto found = std::ranges::find(state.robots, id, &SimRobot::id);
  return found == state.robots.end() ? nullptr : &*found;
}

inline FieldFromRobot pose_of(const SimRobot& robot) {
  return make_pose2<FieldFrame, RobotFrame>(robot.at.x, robot.at.y, robot.theta);
}

}  // namespace tassilo
