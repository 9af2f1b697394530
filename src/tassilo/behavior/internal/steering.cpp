#include "tassilo/behavior/internal/steering.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

/// So much turning for so much error: with pictures that are a tenth of a second old it does not swing yet. [1/s]
constexpr double kTurnGain = 3.5;
/// Ways are compared no further than this: beyond, all will have changed. [m]
constexpr double kHorizon = 1.5;
/// Directions that are tried, and the largest detour. [rad]
constexpr double kStep = 5 * std::numbers::pi / 180, kMaxDetour = 130 * std::numbers::pi / 180;
/// What a blocked way costs, of a detour by so much. [rad]
constexpr double kBlocked = 2.5;
/// And a direction other than the last one, of its difference: no swinging between left and right of something. [1]
constexpr double kOther = 0.3;
/// Floor within so much from ahead is asked for. [rad]
constexpr double kAhead = 15 * std::numbers::pi / 180;

/// How far a point gets from the origin before it is nearer than `radius` to `at`; who is nearer already may leave.
double way_to_disc(FloorPoint at, double radius, FloorPoint unit) {
  const double along = dot(at, unit), across = cross(unit, at);
  if (along <= 0) return 1e9;
  const double least = std::min(radius, norm(at) - 0.01);
  if (least <= 0) return 0;
  if (std::abs(across) >= least) return 1e9;
  return std::max(along - std::sqrt(least * least - across * across), 0.);
}

double way_in_arena(const Situation& now, double direction) {
  const FieldPoint at{now.pose->x, now.pose->y};
  const double heading = now.pose->theta() + direction, dx = std::cos(heading), dy = std::sin(heading);
  double way = 1e9;
  const auto edge = [&](double to_edge, double speed) {
    // Who is outside may only come back.
    if (speed > 1e-6) way = std::min(way, std::max(to_edge / speed, 0.));
  };
  edge(now.arena.x.high - at.x, dx);
  edge(at.x - now.arena.x.low, -dx);
  edge(now.arena.y.high - at.y, dy);
  edge(at.y - now.arena.y.low, -dy);
  return way;
}

/// Is the end of floor that of the ball, or of what it hides?
bool is_at_ball(const Situation& now, const SeenFloor& floor) {
  if (!now.ball) return false;
  const FloorPoint end = floor.end;
  const double away = norm(*now.ball);
  if (distance(end, *now.ball) < now.ball_radius + 0.15) return true;
  if (floor.is_blocked) return false;
  const double half = std::asin(std::min(1., (now.ball_radius + 0.03) / std::max(away, 1e-3)));
  return std::abs(wrap_angle(bearing(end) - bearing(*now.ball))) < half && norm(end) > away - now.ball_radius - 0.15;
}

}  // namespace

double free_way(const Situation& now, double direction, const DriveWish& wish, const PlayerOptions& options) {
  const FloorPoint unit{std::cos(direction), std::sin(direction)};
  const double room = options.radius * (1 + wish.margin);
  double way = now.pose ? way_in_arena(now, direction) : 1e9;
  for (const OtherRobot& other : now.others) way = std::min(way, way_to_disc(other.at, other.radius + room, unit));
  for (const SeenFloor& floor : now.floor)
    if (floor.is_blocked && !is_at_ball(now, floor))
      way = std::min(way, way_to_disc(floor.end, options.radius * (1 + wish.margin / 3), unit));
  if (wish.goes_around_ball && now.ball)
    way = std::min(way, way_to_disc(*now.ball, options.radius * 1.15 + now.ball_radius, unit));
  return way;
}

double seen_ahead(const Situation& now, const PlayerOptions& options) {
  double seen = 1e9;
  bool is_any = false;
  for (const SeenFloor& floor : now.floor) {
    if (std::abs(bearing(floor.end)) > kAhead) continue;
    is_any = true;
    if (!is_at_ball(now, floor)) seen = std::min(seen, norm(floor.end));
  }
  if (!is_any) return 0;
  return std::max(std::min(seen, 8.) - options.radius, 0.);
}

Motion drive_to(const Situation& now, FloorPoint place, const DriveWish& wish, const std::optional<double>& way_before,
                const PlayerOptions& options) {
  const double away = norm(place), straight = bearing(place), needed = std::min(away, kHorizon);
  double best = 1e9, direction = straight;
  const int steps = static_cast<int>(kMaxDetour / kStep);
  for (int k = -steps; k <= steps; ++k) {
    const double tried = straight + k * kStep, way = free_way(now, tried, wish, options);
    const double lacks = needed > 0 ? std::max(needed - way, 0.) / needed : 0;
    const double turned = way_before ? std::abs(wrap_angle(tried - *way_before)) : 0;
    const double cost = std::abs(k * kStep) + kBlocked * lacks + kOther * turned;
    if (cost < best) {
      best = cost;
      direction = wrap_angle(tried);
    }
  }
  Motion motion;
  if (std::abs(wrap_angle(direction - straight)) > kStep) motion.way = direction;
  motion.turn_rate = std::clamp(kTurnGain * direction, -wish.turn_rate, wish.turn_rate);
  const double ahead = std::max(std::cos(direction), 0.);
  motion.speed = wish.speed * ahead * ahead;
  if (wish.stops) motion.speed = std::min(motion.speed, std::sqrt(options.acceleration * away));
  const double free = std::min(free_way(now, 0, wish, options), seen_ahead(now, options));
  motion.speed = std::min(motion.speed, std::sqrt(2 * options.acceleration * free));
  return motion;
}

Motion turn_to(double direction, const PlayerOptions& options) {
  constexpr double kNear = 4 * std::numbers::pi / 180;
  const double error = wrap_angle(direction);
  if (std::abs(error) < kNear) return {};
  return {0, std::clamp(0.8 * kTurnGain * error, -options.max_turn_rate, options.max_turn_rate), {}};
}

WheelCommand wheels_for(const Motion& motion, const PlayerOptions& options) {
  const double half = std::clamp(motion.turn_rate * options.wheel_base / 2, -options.max_speed, options.max_speed);
  const double left_over = options.max_speed - std::abs(half), speed = std::clamp(motion.speed, -left_over, left_over);
  return {speed - half, speed + half, false};
}

}  // namespace tassilo
