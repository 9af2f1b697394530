#pragma once

#include <optional>

#include "tassilo/behavior/internal/situation.h"

namespace tassilo {

/// How the robot is to move.
struct Motion {
  double speed = 0, turn_rate = 0;  ///< [m/s, rad/s]
  std::optional<double> way;        ///< Direction chosen around something. [rad]
};

/// How to get somewhere.
struct DriveWish {
  double speed = 1;        ///< At most. [m/s]
  double turn_rate = 2.5;  ///< At most. [rad/s]
  double margin = 0.35;    ///< Beside the robot. [radii]
  bool stops = true;       ///< At the place; else it drives through.
  bool goes_around_ball = false;
};

/// How far the robot gets straight on in a direction before it touches anything that is known, but for the ball unless
/// it is to be gone around. [m]
double free_way(const Situation& now, double direction, const DriveWish& wish, const PlayerOptions& options);
/// How far the floor straight ahead was seen free, 0 when it was not seen. [m]
double seen_ahead(const Situation& now, const PlayerOptions& options);

/// To a place, around what is known, no faster than it can stop before what it does not know.
Motion drive_to(const Situation& now, FloorPoint place, const DriveWish& wish, const std::optional<double>& way_before,
                const PlayerOptions& options);
/// On the spot towards a direction; none when it is nearly there.
Motion turn_to(double direction, const PlayerOptions& options);

/// Wheels for a motion: where they cannot do both, it turns as asked and drives slower.
WheelCommand wheels_for(const Motion& motion, const PlayerOptions& options);

}  // namespace tassilo
