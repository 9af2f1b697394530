#pragma once

namespace tassilo {

/// What a player wants of a robot with two driven wheels, until the next command.
struct WheelCommand {
  double left = 0, right = 0;  ///< Speed of each wheel over the floor; forward > 0. [m/s]
  bool is_kick = false;        ///< Kick as soon as the ball lies before the robot.
  friend bool operator==(const WheelCommand&, const WheelCommand&) = default;
};

}  // namespace tassilo
