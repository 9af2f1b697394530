#pragma once

#include "tassilo/behavior/internal/situation.h"
#include "tassilo/behavior/internal/steering.h"

// What a player can do: each says how to move, whether to kick, and tells the monitor in words. A skill changes what is
// kept for the next step only where it says so.

namespace tassilo {

struct Deed {
  Motion motion;
  bool is_kick = false;
  const char* action = "";
  const char* planning_state = "";
};

/// What all skills may look at.
struct Play {
  const Situation& now;
  const PlayerInput& input;
  const PlayerOptions& options;
  PlayerState& state;  ///< Of the next step.
  int rank = 0;        ///< Among those of its role.
};

/// Turns until it is known where the robot is.
Deed localize(const Play& play);
/// Looks around, then elsewhere. Keeps since when.
Deed search(const Play& play);
/// Comes from behind the ball, takes it to the other goal, shoots. Keeps where to aim, and since when it has the ball.
Deed strike(const Play& play);
/// Stands between ball and own goal, or beside the ball for what comes back. Keeps whether it is in place.
Deed defend(const Play& play);
/// Stays before the goal on the ball's side, and clears what comes near. Keeps what strike and defend keep.
Deed keep_goal(const Play& play);
/// Out of where nothing goes on.
Deed recover(const Play& play);

/// Is the ball the goalkeeper's?
bool is_in_goal_area(const Situation& now, const FieldModel& field, FieldPoint ball);

}  // namespace tassilo
