#pragma once

#include <cstdint>
#include <optional>

#include "tassilo/base/recycled.h"
#include "tassilo/scene/scene.h"

namespace tassilo {

/// What one robot saw in one image, from where: raw sightings, not tracks, so that nothing in it was counted before.
struct TeamObservation {
  int robot = 0;                     ///< Whose image; unique in the team.
  std::int64_t stamp = 0;            ///< Its own capture time, on whatever clock: robot and stamp are the image. [ns]
  double t = 0;                      ///< When it was captured, on our clock. [s]
  std::optional<PoseSeen> pose;      ///< Of the robot at t.
  RecycledVector<Ball> balls;        ///< In any order; those without floor values are passed over.
  RecycledVector<RobotSeen> robots;  ///< Likewise; teammates among them.
};

}  // namespace tassilo
