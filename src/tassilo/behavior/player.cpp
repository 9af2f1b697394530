#include "tassilo/behavior/player.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/base/option_check.h"
#include "tassilo/behavior/internal/situation.h"
#include "tassilo/behavior/internal/skills.h"
#include "tassilo/behavior/internal/steering.h"

namespace tassilo {
namespace {

/// So far from where it started the robot has got on, in robot radii: more than a pose jumps by noise.
constexpr double kGetsOn = 0.9;
/// How long it backs out of where it is stuck. [s]
constexpr double kBacks = 0.8;

Assignment role_of(const Situation& now, const PlayerState& before, const PlayerInput& input,
                   const PlayerOptions& options) {
  std::vector<Candidate> team;
  Candidate me{input.id, options.is_goalkeeper, {}, {}};
  if (before.role) me.role_before = before.role->role;
  if (now.pose) me.at = FieldPoint{now.pose->x, now.pose->y};
  team.push_back(me);
  for (const Teammate& mate : input.mates) {
    if (mate.age > options.max_team_age || mate.id == input.id) continue;
    Candidate other{mate.id, mate.is_goalkeeper, {}, mate.role};
    if (mate.pose) other.at = FieldPoint{mate.pose->x, mate.pose->y};
    team.push_back(other);
  }
  // All reckon with the same ball where there is one.
  std::optional<FieldPoint> ball;
  if (input.ball && input.ball->age <= options.max_team_age) ball = input.ball->position.mean;
  if (!ball && now.ball && now.pose) ball = now.in_field(*now.ball);
  return assign_role(input.id, team, ball, now.own_goal, options.roles);
}

/// The role there was, until another one has been better for long enough: what mates tell of theirs is late, and two
/// that follow each other's words would change for ever.
Assignment held_role(const Assignment& better, PlayerState& state, const PlayerOptions& options) {
  if (!state.role || better.role == state.role->role) {
    state.other_role_since.reset();
    state.role = better;
  } else if (!state.other_role_since) {
    state.other_role_since = state.t;
  } else if (state.t - *state.other_role_since >= options.role_hold_s) {
    state.other_role_since.reset();
    state.role = better;
  }
  return *state.role;
}

/// Keeps track of whether the robot gets on while its wheels turn.
void watch_progress(PlayerState& state, const Situation& now, double dt, const PlayerOptions& options) {
  if (!now.pose) {
    state.started_from.reset();
    state.driven = 0;
    return;
  }
  const FieldPoint at{now.pose->x, now.pose->y};
  if (!state.started_from || distance(at, *state.started_from) > kGetsOn * options.radius) {
    state.started_from = at;
    state.driven = 0;
  }
  state.driven += std::abs(state.speed) * dt;
  if (state.driven < options.stuck_way || now.t < state.backs_until) return;
  state.started_from = at;
  state.driven = 0;
  state.backs_until = now.t + kBacks;
  ++state.times_stuck;
}

Deed deed_of(const Play& play, Role role) {
  const Situation& now = play.now;
  if (now.t < play.state.backs_until) return recover(play);
  if (!now.pose) {
    // Ball and goal in view are enough for a shot.
    if (role == Role::striker && now.is_ball_seen && now.goal_seen) return strike(play);
    return localize(play);
  }
  if (role == Role::goalkeeper) return keep_goal(play);
  if (!now.ball) return search(play);
  play.state.searches_since.reset();
  const bool is_keepers = is_in_goal_area(now, *play.input.field, now.in_field(*now.ball));
  // Who has not been heard of for long may be gone.
  const auto is_there = [&](const Teammate& mate) { return mate.age <= play.options.max_team_age; };
  const bool has_keeper =
      std::ranges::any_of(play.input.mates, [&](const Teammate& m) { return m.is_goalkeeper && is_there(m); });
  if (role == Role::striker && !(is_keepers && has_keeper)) return strike(play);
  play.state.has_ball_since.reset();
  // A striker that leaves the ball to the goalkeeper stands where no defender does.
  if (role == Role::striker)
    return defend({now, play.input, play.options, play.state,
                   static_cast<int>(std::ranges::count_if(play.input.mates, is_there))});
  return defend(play);
}

}  // namespace

void PlayerOptions::check() const {
  check_above("player.radius", radius, 0);
  check_above("player.wheel_base", wheel_base, 0);
  check_above("player.max_speed", max_speed, 0);
  check_above("player.acceleration", acceleration, 0);
  check_above("player.max_turn_rate", max_turn_rate, 0);
  check_above("player.dribble_turn_rate", dribble_turn_rate, 0);
  check_above("player.dribble_speed", dribble_speed, 0);
  check_at_least("player.kick_reach", kick_reach, 0);
  check_above("player.kick_deg", kick_deg, 0);
  check_above("player.ball_friction", ball_friction, 0);
  check_at_least("player.margin", margin, 0);
  check_above("player.max_pose_age", max_pose_age, 0);
  check_above("player.max_team_age", max_team_age, 0);
  check_at_least("player.role_hold_s", role_hold_s, 0);
  check_above("player.stuck_way", stuck_way, 0);
  roles.check();
}

PlayerOptions player_options(const FieldModel& field) {
  PlayerOptions options;
  options.radius = field.robots.width.middle() / 2;
  options.wheel_base = 1.6 * options.radius;
  return options;
}

std::optional<GoalSide> side_of_goal(const FieldModel& field, GoalColor color) {
  for (const FieldModel::Goal& goal : field.goals)
    if (goal.color == color) return goal.side;
  return std::nullopt;
}

PlayerStep play(const PlayerState& before, const PlayerInput& input, const PlayerOptions& options) {
  PlayerStep step;
  PlayerState& state = step.state;
  state = before;
  state.t = std::max(input.t, before.t);
  const double dt = std::clamp(input.t - before.t, 0., 0.5);
  const Situation now = situation(before, input, options);
  const Assignment assigned = held_role(role_of(now, before, input, options), state, options);
  if (now.ball && now.pose && !now.is_ball_remembered) {
    state.ball_was_at = now.in_field(*now.ball);
    state.ball_known_at = now.t;
  }
  watch_progress(state, now, dt, options);

  Deed deed = deed_of({now, input, options, state, assigned.rank}, assigned.role);
  // Whatever it is doing: not faster into what was not seen free than it can stop.
  deed.motion.speed = std::min(deed.motion.speed, std::sqrt(2 * options.acceleration * seen_ahead(now, options)));
  state.way = deed.motion.way;
  step.output.wheels = wheels_for(deed.motion, options);
  step.output.wheels.is_kick = deed.is_kick;
  step.output.role = assigned.role;
  step.output.action = deed.motion.way && deed.motion.speed < 0.2 * options.max_speed ? "avoid" : deed.action;
  step.output.planning_state = deed.planning_state;

  // What the wheels make of it until the next step.
  const double speed = (step.output.wheels.left + step.output.wheels.right) / 2;
  const double turn_rate = (step.output.wheels.right - step.output.wheels.left) / options.wheel_base;
  const double change = options.acceleration * std::max(dt, 0.03), turn = 2 * change / options.wheel_base;
  state.speed += std::clamp(speed - state.speed, -change, change);
  state.turn_rate += std::clamp(turn_rate - state.turn_rate, -turn, turn);
  return step;
}

}  // namespace tassilo
