#include "tassilo/behavior/internal/skills.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

/// Turning with the ball, for so much error. [1/s]
constexpr double kDribbleGain = 3;
/// Turning after a ball that rolls off to a side. [1/s]
constexpr double kFollowGain = 4;

FloorPoint unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

/// To a place, then turned to something; in place until it is pushed well away, so that noise does not make it fidget.
Deed stand_at(const Play& play, FieldPoint place, FloorPoint looks_at, const char* action) {
  const Situation& now = play.now;
  const FloorPoint to = now.in_robot(now.clamped(place));
  const double near = 0.6 * play.options.radius, far = 1.6 * play.options.radius;
  play.state.is_in_place = norm(to) < (play.state.is_in_place ? far : near);
  if (play.state.is_in_place) return {turn_to(bearing(looks_at), play.options), false, action, "watch the ball"};
  DriveWish wish{
      .speed = play.options.max_speed, .turn_rate = play.options.max_turn_rate, .margin = play.options.margin};
  wish.goes_around_ball = true;
  return {drive_to(now, to, wish, play.state.way, play.options), false, action, "go to its place"};
}

/// Where to push the ball: to the goal as far as there is room for the robot behind the ball and for the ball before
/// it; never to the own goal if it can be helped. Direction in the robot frame.
double push_direction(const Play& play, FloorPoint ball, FloorPoint goal) {
  const Situation& now = play.now;
  const double straight = bearing(goal - ball), radius = play.options.radius, reach = radius + now.ball_radius;
  constexpr double kStep = 10 * std::numbers::pi / 180;
  double best = 1e9, direction = straight;
  for (int k = -18; k < 18; ++k) {
    const double tried = straight + k * kStep;
    const FloorPoint behind = ball - reach * unit(tried);
    double cost = std::abs(k) * kStep;
    if (now.pose) {
      const FieldPoint stand = now.in_field(behind), ahead = now.in_field(ball + unit(tried));
      const double lacks = distance(now.clamped(stand), stand);
      if (lacks > 0.15 * radius) cost += 2 + lacks;
      if (distance(ahead, now.own_goal) < distance(now.in_field(ball), now.own_goal) - 0.3) cost += 1;
    }
    for (const OtherRobot& other : now.others) {
      if (distance(other.at, behind) < other.radius + 0.9 * radius) cost += 1;
      const FloorPoint to = other.at - ball;
      const double along = dot(to, unit(tried)), across = std::abs(cross(unit(tried), to));
      // Close by it cannot even begin to roll.
      if (along > 0 && along < 3 * reach && across < other.radius + now.ball_radius)
        cost += along < 1.5 * reach ? 1.5 : 0.7;
    }
    if (cost < best) {
      best = cost;
      direction = tried;
    }
  }
  return direction;
}

/// How much room a shot from the ball to a place has beside other robots, at most 1. [m]
double room_of_shot(const Situation& now, FloorPoint ball, FloorPoint place) {
  const FloorPoint way = place - ball;
  const double length = norm(way);
  double room = 1;
  if (length < 1e-6) return room;
  for (const OtherRobot& other : now.others) {
    const FloorPoint to = other.at - ball;
    const double along = dot(to, way) / length;
    if (along < 0.1 || along > length + other.radius) continue;
    room = std::min(room, std::abs(cross(way, to)) / length - other.radius - now.ball_radius);
  }
  return room;
}

/// The middle of the other goal's mouth, or a place in it where there is more room. Robot frame.
FloorPoint aimed_goal(const Play& play, FloorPoint ball) {
  const Situation& now = play.now;
  if (!now.pose) return *now.goal_seen;
  const auto place = [&](double share) {
    return now.in_robot({now.other_goal.x, share * (now.goal_half_width - now.ball_radius)});
  };
  double best = -1e9, aim = 0;
  for (const double share : {-0.8, -0.6, -0.4, -0.2, 0., 0.2, 0.4, 0.6, 0.8}) {
    const double kept = std::abs(share - play.state.aim) < 0.1 ? 0.15 : 0;
    const double value = std::min(room_of_shot(now, ball, place(share)), 0.4) + kept - 0.1 * std::abs(share);
    if (value > best) {
      best = value;
      aim = share;
    }
  }
  play.state.aim = aim;
  return place(aim);
}

/// Would a ball kicked now go into the other goal?
bool is_on_target(const Play& play, FloorPoint ball) {
  const Situation& now = play.now;
  const double safe = now.goal_half_width - 1.5 * now.ball_radius;
  if (!now.pose) {
    const FloorPoint to = *now.goal_seen - ball;
    return std::abs(bearing(to)) < std::atan2(0.7 * safe, norm(to));
  }
  const FieldPoint from = now.in_field(ball), ahead = now.in_field(ball + FloorPoint{1, 0}), way = ahead - from;
  const double to_line = now.other_goal.x - from.x;
  if (way.x * to_line <= 0) return false;
  return std::abs(from.y + way.y * to_line / way.x) < safe;
}

bool has_ball(const Play& play) {
  const Situation& now = play.now;
  if (!now.ball || !now.is_ball_seen) return false;
  // Once it has it, it believes in it a little longer.
  const double loose = play.state.has_ball_since ? 2 : 1;
  const double reach = play.options.radius + now.ball_radius + loose * (0.03 + play.options.kick_reach);
  return norm(*now.ball) < reach && std::abs(bearing(*now.ball)) < loose * radians(play.options.kick_deg);
}

Deed with_ball(const Play& play, FloorPoint ball, FloorPoint goal) {
  const Situation& now = play.now;
  const PlayerOptions& options = play.options;
  const double held = now.t - *play.state.has_ball_since, to_goal = norm(goal - ball);
  const bool is_before = std::abs(bearing(ball)) < radians(options.kick_deg);
  // Where heading, pose and kick are some degrees off, a goal that is seen under less is often missed.
  const bool is_near = std::atan2(now.goal_half_width, to_goal) > radians(8);
  const double room = room_of_shot(now, ball, ball + FloorPoint{to_goal, 0});
  const bool is_pressed = std::ranges::any_of(now.others, [&](const OtherRobot& other) {
    return !other.is_mate && norm(other.at) < 4 * options.radius && other.at.x > 0;
  });
  if (is_before && is_on_target(play, ball) && (is_near || is_pressed) && (room > 0 || held > 2.5))
    return {{options.dribble_speed, 0, {}}, true, "shoot", "ball to the goal"};
  const DriveWish wish{
      .speed = options.dribble_speed, .turn_rate = options.dribble_turn_rate, .margin = 0.2, .stops = false};
  Motion motion = drive_to(now, goal, wish, play.state.way, options);
  // The front takes the ball along in a slow turn, but the ball lags and rolls off at the other side: the slower the
  // further it has rolled. One that lies on the side of the turn is only got better by it.
  const double side = bearing(ball), to_way = motion.way.value_or(bearing(goal));
  const double lags = to_way * side < 0 ? std::abs(side) / radians(options.kick_deg) : 0;
  motion.turn_rate = std::clamp(kDribbleGain * to_way, -options.dribble_turn_rate, options.dribble_turn_rate);
  if (lags > 0) motion.turn_rate *= std::max(1 - 0.5 * lags, 0.2);
  if (lags == 0) motion.turn_rate += kFollowGain * side;
  // A ball before a robot that stands does not turn with it.
  motion.speed = std::max(std::min(motion.speed, options.dribble_speed), 0.4 * options.dribble_speed);
  motion.speed = std::min(motion.speed, std::sqrt(2 * options.acceleration * free_way(now, 0, wish, options)));
  return {motion, false, "dribble", is_on_target(play, ball) ? "wait for a free way" : "turn to the goal"};
}

Deed to_ball(const Play& play, FloorPoint ball, FloorPoint goal) {
  const Situation& now = play.now;
  const PlayerOptions& options = play.options;
  const double touch = options.radius + now.ball_radius;
  const double push = push_direction(play, ball, goal);
  const double off = wrap_angle(bearing(ball) - push), away = norm(ball);
  if (std::abs(off) < radians(35)) {
    // Along the line behind the ball, which it meets the sooner the further off it is.
    const FloorPoint place = ball - std::max(0.8 * (away - touch), 0.) * unit(push);
    const DriveWish wish{.speed = options.max_speed, .turn_rate = options.max_turn_rate, .margin = 0.1, .stops = false};
    Motion motion = drive_to(now, place, wish, play.state.way, options);
    if (away < 2 * touch) motion.speed = std::min(motion.speed, options.dribble_speed);
    return {motion, false, "go_to_ball", "take the ball"};
  }
  DriveWish wish{.speed = options.max_speed, .turn_rate = options.max_turn_rate, .margin = 0.2, .stops = false};
  wish.goes_around_ball = true;
  FloorPoint behind = ball - (touch + 0.8 * options.radius) * unit(push);
  if (now.pose) behind = now.in_robot(now.clamped(now.in_field(behind)));
  return {drive_to(now, behind, wish, play.state.way, options), false, "go_to_ball", "go behind the ball"};
}

}  // namespace

bool is_in_goal_area(const Situation& now, const FieldModel& field, FieldPoint ball) {
  const double depth = field.areas.empty() ? 0.12 * field.length : field.areas[0].depth;
  const double half = std::max(field.areas.empty() ? 0 : field.areas[0].width / 2, now.goal_half_width);
  return std::abs(ball.x - now.own_goal.x) < depth && std::abs(ball.y) < half;
}

Deed localize(const Play& play) {
  return {{0, 0.3 * play.options.max_turn_rate, {}}, false, "localize", "look for lines and goals"};
}

Deed search(const Play& play) {
  const Situation& now = play.now;
  const PlayerOptions& options = play.options;
  if (!play.state.searches_since) {
    play.state.searches_since = now.t;
    play.state.search_side = play.state.ball_was_at && now.pose && now.in_robot(*play.state.ball_was_at).y < 0 ? -1 : 1;
  }
  // Once around, then on to another place, and again.
  const double turn_rate = 0.6 * options.max_turn_rate, around = 2 * std::numbers::pi / turn_rate, drive = 5;
  const double since = now.t - *play.state.searches_since, round = std::floor(since / (around + drive));
  if (since - round * (around + drive) < around || !now.pose)
    return {{0, play.state.search_side * turn_rate, {}}, false, "search", "look around"};
  const double x = play.input.field->length / 4, y = play.input.field->width / 4;
  const std::array<FieldPoint, 5> places{{{0, 0}, {x, y}, {-x, -y}, {x, -y}, {-x, y}}};
  const auto place = places[static_cast<std::size_t>(play.input.id + static_cast<int>(round)) % places.size()];
  const DriveWish wish{.speed = 0.7 * options.max_speed, .turn_rate = options.max_turn_rate, .margin = options.margin};
  return {drive_to(now, now.in_robot(place), wish, play.state.way, options), false, "search", "look elsewhere"};
}

Deed strike(const Play& play) {
  const Situation& now = play.now;
  const PlayerOptions& options = play.options;
  FloorPoint ball = *now.ball;
  // Beside the robot it is out of view while the robot goes around it. But what was not seen for long must be looked
  // for.
  constexpr double kLong = 1.5;
  if (!now.is_ball_seen && now.ball_age > kLong && norm(ball) < 4 * options.radius)
    return {turn_to(bearing(ball), options), false, "go_to_ball", "look for the ball"};
  const FloorPoint goal = aimed_goal(play, ball);
  if (!has_ball(play)) {
    play.state.has_ball_since.reset();
    // Too far to the side of the ball to take it to the goal: around it is quicker than in a wide turn that loses it.
  } else if (std::abs(wrap_angle(bearing(ball) - bearing(goal - ball))) <
             radians(play.state.has_ball_since ? 60 : 45)) {
    if (!play.state.has_ball_since) play.state.has_ball_since = now.t;
    return with_ball(play, ball, goal);
  } else {
    play.state.has_ball_since.reset();
  }
  // Where it will be when the robot is there; a guess, so not far ahead.
  const double until = std::min(norm(ball) / options.max_speed, 1.);
  ball = rolled(ball, now.ball_velocity, until, options.ball_friction);
  if (now.pose) {
    const FieldPoint at = now.in_field(ball);
    const FieldExtent& arena = now.arena;
    const double slack = options.radius - now.ball_radius;
    ball = now.in_robot({std::clamp(at.x, arena.x.low - slack, arena.x.high + slack),
                         std::clamp(at.y, arena.y.low - slack, arena.y.high + slack)});
  }
  return to_ball(play, ball, goal);
}

Deed defend(const Play& play) {
  const Situation& now = play.now;
  const FieldPoint ball = now.in_field(*now.ball), from_goal = ball - now.own_goal;
  const double away = std::max(norm(from_goal), 1e-6), length = play.input.field->length;
  if (play.rank == 0 && away > 0.33 * length) {
    // Half way, but neither in the goalkeeper's way nor in the striker's.
    const double along = std::clamp(0.5 * away, 0.18 * length, away - 0.15 * length);
    return stand_at(play, now.own_goal + along / away * from_goal, *now.ball, "defend");
  }
  if (play.rank == 0) {
    // Near the own goal there is a crowd already: where the ball may come out of it.
    const FieldPoint out = FieldPoint{0, 0} - ball;
    return stand_at(play, ball + 0.15 * length / std::max(norm(out), 1e-6) * out, *now.ball, "defend");
  }
  // For what comes back from the fight for the ball: behind it, on the side where the field is wider.
  const double back = now.own_goal.x > 0 ? 1 : -1, side = ball.y > 0 ? -1 : 1;
  const double width = play.input.field->width;
  const FieldPoint place{ball.x + back * 0.12 * length * play.rank, ball.y + side * 0.28 * width};
  return stand_at(play, place, *now.ball, "defend");
}

Deed keep_goal(const Play& play) {
  const Situation& now = play.now;
  const PlayerOptions& options = play.options;
  const double out = now.own_goal.x > 0 ? -1 : 1, stand = 1.8 * options.radius;
  const FieldPoint home = now.own_goal + FieldPoint{out * stand, 0};
  if (!now.ball) {
    play.state.is_in_place = distance(home, {now.pose->x, now.pose->y}) < 1.6 * options.radius;
    if (!play.state.is_in_place) return stand_at(play, home, {1, 0}, "keep_goal");
    // Looks from corner to corner.
    const double wanted = (out > 0 ? 0 : std::numbers::pi) + radians(60) * std::sin(0.8 * now.t);
    return {turn_to(wanted - now.pose->theta(), options), false, "search", "look for the ball"};
  }
  const FieldPoint ball = now.in_field(*now.ball);
  if (now.is_ball_seen && is_in_goal_area(now, *play.input.field, ball)) {
    Deed deed = strike(play);
    // Away is where it should go, wherever that is but not along the own goal.
    const double heading = now.pose->theta();
    if (has_ball(play) && out * std::cos(heading) > 0.5) deed.is_kick = true;
    deed.action = "clear";
    return deed;
  }
  play.state.has_ball_since.reset();
  const double most = now.goal_half_width - 0.5 * options.radius;
  const FieldPoint from_goal = ball - now.own_goal, to_ball = 1 / std::max(norm(from_goal), 1e-6) * from_goal;
  double y = to_ball.y * (stand + 0.5 * options.radius) / std::max(out * to_ball.x, 0.3);
  // A shot is met where it crosses.
  const FieldPoint velocity = now.in_field(now.ball_velocity) - FieldPoint{now.pose->x, now.pose->y};
  if (-out * velocity.x > 0.5) {
    const double time = (out * (ball.x - home.x)) / (-out * velocity.x), crosses = ball.y + time * velocity.y;
    if (time > 0 && time < 3 && std::abs(crosses) < now.goal_half_width + options.radius) y = crosses;
  }
  return stand_at(play, {home.x, std::clamp(y, -most, most)}, *now.ball, "keep_goal");
}

Deed recover(const Play& play) {
  const PlayerOptions& options = play.options;
  const DriveWish wish{.margin = 0.1};
  const double side = play.state.times_stuck % 2 == 0 ? 1 : -1;
  const double room = free_way(play.now, std::numbers::pi, wish, options);
  const double speed = room > 0.3 * options.radius ? -0.25 * options.max_speed : 0;
  return {{speed, side * 0.4 * options.max_turn_rate, {}}, false, "recover", "back out"};
}

}  // namespace tassilo
