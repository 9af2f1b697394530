#include "tassilo/sim/world.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/base/option_check.h"
#include "tassilo/field/field_curves.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {
namespace {

/// Things that touch are put so far apart, so that rounding does not let them overlap. [m]
constexpr double kGap = 1e-9;
/// What still counts as apart. [m]
constexpr double kTouch = 1e-7;
/// In a crowd each push may move others; what is not apart after so many rounds stays where it was.
constexpr int kRounds = 24;

/// Which way, and how far, a disc has to go to leave a barrier.
struct Push {
  FieldPoint normal;
  double depth = 0;
};
std::optional<Push> push_out(FieldPoint at, double radius, const Barrier& barrier) {
  const FieldPoint along = barrier.q - barrier.p;
  const double share = std::clamp(dot(at - barrier.p, along) / std::max(dot(along, along), 1e-12), 0., 1.);
  const FieldPoint away = at - (barrier.p + share * along);
  const double gap = norm(away);
  if (gap >= radius) return std::nullopt;
  // Exactly on it: there is no side it came from, so the field's.
  if (gap < 1e-12) return Push{-1 / std::max(norm(at), 1e-12) * at, radius};
  return Push{1 / gap * away, radius - gap};
}

void check_share(const std::string& option, double value) {
  if (!(value >= 0 && value <= 1)) throw Error(option, "is " + std::to_string(value) + ", must be 0..1");
}

double end_of(GoalSide side) { return side == GoalSide::plus_x ? 1 : -1; }
GoalSide other(GoalSide side) { return side == GoalSide::plus_x ? GoalSide::minus_x : GoalSide::plus_x; }
Team other(Team team) { return team == Team::cyan ? Team::magenta : Team::cyan; }

std::vector<Barrier> barriers_of(const FieldModel& field, const WorldOptions& options) {
  std::vector<Barrier> barriers;
  FieldExtent extent = field_extent(field);
  if (!field.walls) {
    extent.x = {extent.x.low - options.run_off, extent.x.high + options.run_off};
    extent.y = {extent.y.low - options.run_off, extent.y.high + options.run_off};
  }
  const auto end_wall = [&](GoalSide side) {
    const double x = side == GoalSide::plus_x ? extent.x.high : extent.x.low;
    double y = extent.y.low;
    for (const FieldModel::Goal& goal : field.goals) {
      // A goal in the wall; one that stands free before it leaves it whole.
      if (goal.side != side || field.length / 2 + goal.depth <= std::abs(x)) continue;
      barriers.push_back({{x, y}, {x, -goal.width / 2}});
      y = goal.width / 2;
    }
    barriers.push_back({{x, y}, {x, extent.y.high}});
  };
  end_wall(GoalSide::plus_x);
  end_wall(GoalSide::minus_x);
  barriers.push_back({{extent.x.low, extent.y.low}, {extent.x.high, extent.y.low}});
  barriers.push_back({{extent.x.low, extent.y.high}, {extent.x.high, extent.y.high}});
  for (const FieldModel::Goal& goal : field.goals) {
    const double mouth = end_of(goal.side) * field.length / 2, back = mouth + end_of(goal.side) * goal.depth;
    for (const double y : {-goal.width / 2, goal.width / 2}) barriers.push_back({{mouth, y}, {back, y}});
    barriers.push_back({{back, -goal.width / 2}, {back, goal.width / 2}});
  }
  return barriers;
}

double robot_radius(const FieldModel& field) { return field.robots.width.middle() / 2; }

}  // namespace

void WorldOptions::check() const {
  check_above("world.ball_friction", ball_friction, 0);
  check_share("world.wall_restitution", wall_restitution);
  check_share("world.robot_restitution", robot_restitution);
  check_above("world.wheel_base", wheel_base, 0);
  if (!(wheel_base <= 1)) throw Error("world.wheel_base", "is " + std::to_string(wheel_base) + ", must be <= 1");
  check_above("world.max_wheel_speed", max_wheel_speed, 0);
  check_above("world.max_wheel_acceleration", max_wheel_acceleration, 0);
  check_at_least("world.slip_sigma", slip_sigma, 0);
  check_at_least("world.wheel_sigma", wheel_sigma, 0);
  check_above("world.slip_correlation_s", slip_correlation_s, 0);
  check_above("world.guide_deg", guide_deg, 0);
  if (!(guide_deg < 90)) throw Error("world.guide_deg", "is " + std::to_string(guide_deg) + ", must be < 90");
  check_above("world.guide_time_s", guide_time_s, 0);
  check_at_least("world.guide_acceleration", guide_acceleration, 0);
  check_at_least("world.kick_speed", kick_speed, 0);
  check_at_least("world.kick_reach", kick_reach, 0);
  check_at_least("world.kick_sigma_deg", kick_sigma_deg, 0);
  check_at_least("world.kick_pause_s", kick_pause_s, 0);
  check_above("world.run_off", run_off, 0);
  check_above("world.stuck_s", stuck_s, 0);
  check_above("world.stuck_distance", stuck_distance, 0);
  for (const auto& [name, value] : {std::pair{"world.max_wheel_speed", max_wheel_speed},
                                    {"world.max_wheel_acceleration", max_wheel_acceleration},
                                    {"world.ball_friction", ball_friction},
                                    {"world.slip_sigma", slip_sigma},
                                    {"world.wheel_sigma", wheel_sigma},
                                    {"world.guide_acceleration", guide_acceleration},
                                    {"world.kick_speed", kick_speed},
                                    {"world.kick_reach", kick_reach},
                                    {"world.kick_sigma_deg", kick_sigma_deg},
                                    {"world.run_off", run_off}})
    check_finite(name, value);
}

std::string_view to_string(RefereeCall call) {
  switch (call) {
    case RefereeCall::kick_off:
      return "kick_off";
    case RefereeCall::goal:
      return "goal";
    case RefereeCall::ball_out:
      return "ball_out";
    case RefereeCall::stuck_ball:
      return "stuck_ball";
  }
  return "";
}

std::vector<KickOffPlace> kick_off_places(const FieldModel& field, GoalSide own_goal, int robots, bool has_kick_off) {
  expects(robots >= 0, "kick_off_places: a number of robots");
  const double radius = robot_radius(field), ball = field.ball.radius.middle();
  const double half = field.length / 2, side = end_of(own_goal),
               theta = own_goal == GoalSide::plus_x ? std::numbers::pi : 0;
  const double keeper = half - radius - std::min(radius, 0.1 * half);
  const double front = std::max(field.circle_radius + 1.2 * radius, 0.3 * half);
  // Rows between the circle and the goalkeeper; each row from the middle outwards.
  const int others = std::max(robots - 1, 0), rows = others > 6 ? 3 : others > 2 ? 2 : 1;
  std::vector<KickOffPlace> places;
  if (robots > 0) places.push_back({{side * keeper, 0}, theta});
  for (int k = 0; k < others; ++k) {
    const int row = k % rows, in_row = k / rows, count = (others - row + rows - 1) / rows;
    const double share = rows > 1 ? static_cast<double>(row) / rows : 0;
    const double x = side * (front + share * (keeper - front));
    const double y = ((in_row + 0.5) / count - 0.5) * 0.8 * field.width;
    places.push_back({{x, y}, theta});
  }
  // Just off the ball: it is the others' as soon as they are quicker.
  if (has_kick_off && robots > 1) places[1].at = {side * (radius + ball + 0.25 * radius), 0};
  for (std::size_t a = 0; a < places.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (distance(places[a].at, places[b].at) < 2.1 * radius)
        throw Error("world.robots", std::to_string(robots) + " of a team find no room on the field, must be fewer");
  return places;
}

World::World(const FieldModel& field, const WorldOptions& options) : field_(field), options_(options) {
  field_.check();
  options_.check();
  barriers_ = barriers_of(field_, options_);
  state_.ball.radius = field_.ball.radius.middle();
}

GoalSide World::own_goal(Team team) const {
  return team == Team::cyan ? options_.cyan_own_goal : other(options_.cyan_own_goal);
}

std::size_t World::index_of(int id) const {
  const SimRobot* const found = find_robot(state_, id);
  if (found == nullptr) throw Error("world.robot", "is " + std::to_string(id) + ", must be on the field");
  return static_cast<std::size_t>(found - state_.robots.data());
}

void World::add(int id, Team team) {
  if (id < 0 || id > 255) throw Error("world.robot", "is " + std::to_string(id) + ", must be 0..255");
  if (team == Team::unknown) throw Error("world.team", "is unknown, must be cyan or magenta");
  const auto place = std::ranges::lower_bound(state_.robots, id, {}, &SimRobot::id);
  if (place != state_.robots.end() && place->id == id)
    throw Error("world.robot", "is " + std::to_string(id) + ", must not be on the field already");
  const auto mates = std::ranges::count(state_.robots, team, &SimRobot::team);
  kick_off_places(field_, own_goal(team), static_cast<int>(mates) + 1, true);  // Throws when there is no room.

  SimRobot robot;
  robot.id = id;
  robot.team = team;
  robot.radius = robot_radius(field_);
  robot.height = field_.robots.height.middle();
  const double side = end_of(own_goal(team));
  robot.theta = own_goal(team) == GoalSide::plus_x ? std::numbers::pi : 0;
  if (ticks_ > 0) robot.at = free_spot({side * field_.length / 4, 0}, robot.radius, 0);
  Drive drive;
  // Each robot has luck of its own, so that one more or less does not change that of the others.
  std::seed_seq seeds{static_cast<std::uint32_t>(options_.seed), static_cast<std::uint32_t>(options_.seed >> 32),
                      static_cast<std::uint32_t>(id)};
  drive.random.seed(seeds);
  std::normal_distribution<double> wheel;
  drive.left_scale = 1 + options_.wheel_sigma * wheel(drive.random);
  drive.right_scale = 1 + options_.wheel_sigma * wheel(drive.random);
  drives_.insert(drives_.begin() + (place - state_.robots.begin()), drive);
  state_.robots.insert(place, robot);
  if (ticks_ == 0) line_up();
}

void World::remove(int id) {
  const auto i = static_cast<std::ptrdiff_t>(index_of(id));
  state_.robots.erase(state_.robots.begin() + i);
  drives_.erase(drives_.begin() + i);
  if (ticks_ == 0) line_up();
}

void World::place(int id, FieldPoint at, double theta) {
  const std::size_t i = index_of(id);
  SimRobot robot = state_.robots[i];
  const auto stands_in_the_way = [&](const SimRobot& there) {
    return there.id != id && distance(there.at, at) < there.radius + robot.radius;
  };
  const auto blocks = [&](const Barrier& barrier) { return push_out(at, robot.radius, barrier).has_value(); };
  if (std::ranges::any_of(state_.robots, stands_in_the_way) || std::ranges::any_of(barriers_, blocks) ||
      distance(state_.ball.at, at) < state_.ball.radius + robot.radius)
    throw Error("world.robot", std::to_string(id) + " finds no room at its place");
  robot.at = at;
  robot.theta = wrap_angle(theta);
  robot.speed = robot.turn = 0;
  state_.robots[i] = robot;
  drives_[i].left = drives_[i].right = drives_[i].vx = drives_[i].vy = 0;
}

void World::place_ball(FieldPoint at, double vx, double vy) {
  const auto stands_in_the_way = [&](const SimRobot& there) {
    return distance(there.at, at) < there.radius + state_.ball.radius;
  };
  const auto blocks = [&](const Barrier& barrier) { return push_out(at, state_.ball.radius, barrier).has_value(); };
  if (std::ranges::any_of(state_.robots, stands_in_the_way) || std::ranges::any_of(barriers_, blocks))
    throw Error("world.ball", "finds no room at its place");
  state_.ball.at = at;
  state_.ball.vx = vx;
  state_.ball.vy = vy;
  ball_stays_at_ = at;
  ball_stays_since_ = state_.t;
}

OdometrySample World::odometry(int id) const {
  const Drive& drive = drives_[index_of(id)];
  return {state_.t, drive.odometry_x, drive.odometry_y, wrap_angle(drive.odometry_theta)};
}

double World::wheel_base(int id) const { return options_.wheel_base * 2 * state_.robots[index_of(id)].radius; }

void World::line_up() {
  for (const Team team : {Team::cyan, Team::magenta}) {
    const auto count = static_cast<int>(std::ranges::count(state_.robots, team, &SimRobot::team));
    const auto places = kick_off_places(field_, own_goal(team), count, team == kick_off_team_);
    std::size_t next = 0;
    for (std::size_t i = 0; i < state_.robots.size(); ++i) {
      if (state_.robots[i].team != team) continue;
      state_.robots[i].at = places[next].at;
      state_.robots[i].theta = wrap_angle(places[next].theta);
      state_.robots[i].speed = state_.robots[i].turn = 0;
      drives_[i].left = drives_[i].right = drives_[i].vx = drives_[i].vy = 0;
      ++next;
    }
  }
}

void World::kick_off(Team team, std::vector<RefereeEvent>& events) {
  kick_off_team_ = team;
  state_.ball.vx = state_.ball.vy = 0;
  if (options_.places_robots_at_kick_off) {
    line_up();
    state_.ball.at = {0, 0};
    ball_stays_at_ = state_.ball.at;
    ball_stays_since_ = state_.t;
  } else {
    put_ball_to_free_spot({0, 0});
  }
  events.push_back({state_.t, RefereeCall::kick_off, team});
}

double World::clearance(FieldPoint at) const {
  double least = 1e9;
  for (const SimRobot& robot : state_.robots) least = std::min(least, distance(robot.at, at) - robot.radius);
  for (const Barrier& barrier : barriers_)
    if (const auto push = push_out(at, least, barrier)) least = least - push->depth;
  return least;
}

/// The nearest neutral spot where a disc has some air around it; else, in a crowd, the spot with the most air on a
/// grid.
FieldPoint World::free_spot(FieldPoint near, double radius, double away_from) const {
  const double x = field_.length / 4, y = field_.width / 4;
  std::vector<FieldPoint> spots{{0, 0}, {x, y}, {x, -y}, {-x, y}, {-x, -y}};
  std::ranges::stable_sort(spots, {}, [&](FieldPoint spot) { return distance(spot, near); });
  const double air = radius + 0.5 * robot_radius(field_);
  for (const FieldPoint spot : spots)
    if (clearance(spot) >= air && distance(spot, near) >= away_from) return spot;
  FieldPoint best;
  double most = -1e9;
  constexpr int kHalfGrid = 20;
  for (int i = -kHalfGrid + 1; i < kHalfGrid; ++i)
    for (int k = -kHalfGrid + 1; k < kHalfGrid; ++k) {
      const FieldPoint spot{field_.length / 2 * i / kHalfGrid, field_.width / 2 * k / kHalfGrid};
      const double here = std::min(clearance(spot), air) - 1e-3 * distance(spot, near);
      if (here > most && distance(spot, near) >= away_from) {
        most = here;
        best = spot;
      }
    }
  if (clearance(best) < radius) throw Error("world", "has no room left for anything");
  return best;
}

void World::put_ball_to_free_spot(FieldPoint near) {
  state_.ball.vx = state_.ball.vy = 0;
  state_.ball.at = free_spot(near, state_.ball.radius, options_.stuck_distance * field_.length);
  ball_stays_at_ = state_.ball.at;
  ball_stays_since_ = state_.t;
}

std::vector<RefereeEvent> World::step(double dt, std::span<const RobotCommand> commands) {
  expects(dt >= 0, "World::step: time goes forward");
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    drives_[i].command = {};
    for (const RobotCommand& command : commands)
      if (command.robot == state_.robots[i].id) drives_[i].command = command.wheels;
  }
  std::vector<RefereeEvent> events;
  if (ticks_ == 0 && dt > 0) events.push_back({0, RefereeCall::kick_off, kick_off_team_});
  asked_ += dt;
  const std::int64_t until = std::llround(asked_ / kTick);
  while (ticks_ < until) tick(events);
  return events;
}

void World::tick(std::vector<RefereeEvent>& events) {
  std::vector<FieldPoint> before;
  for (const SimRobot& robot : state_.robots) before.push_back(robot.at);
  const SimBall ball_before = state_.ball;
  for (std::size_t i = 0; i < drives_.size(); ++i) drive(i);
  const auto stay = [&] {
    for (std::size_t i = 0; i < before.size(); ++i) state_.robots[i].at = before[i];
  };
  const auto measure = [&] {
    for (std::size_t i = 0; i < before.size(); ++i) {
      SimRobot& robot = state_.robots[i];
      drives_[i].vx = (robot.at.x - before[i].x) / kTick;
      drives_[i].vy = (robot.at.y - before[i].y) / kTick;
      robot.speed = drives_[i].vx * std::cos(robot.theta) + drives_[i].vy * std::sin(robot.theta);
    }
  };
  std::vector<FieldPoint> driven;
  for (const SimRobot& robot : state_.robots) driven.push_back(robot.at);
  push_robots_apart();
  if (!are_robots_apart()) stay();
  measure();

  ++ticks_;
  state_.t = static_cast<double>(ticks_) * kTick;
  for (std::size_t i = 0; i < drives_.size(); ++i) kick(i);
  const std::size_t called = events.size();
  roll_ball(events);
  if (events.size() > called) return;  // All stands anew.
  // A ball that cannot give way, as between a robot and a wall, stops the robot.
  for (int round = 0; round < kRounds && !is_ball_clear(); ++round) {
    for (SimRobot& robot : state_.robots) {
      const FieldPoint away = robot.at - state_.ball.at;
      const double gap = norm(away), least = robot.radius + state_.ball.radius;
      if (gap < least && gap > 0) robot.at = robot.at + (least - gap + kGap) / gap * away;
    }
    push_robots_apart();
    bounce_ball();
  }
  if (!is_ball_clear() || !are_robots_apart()) {
    stay();
    state_.ball.at = ball_before.at;
    state_.ball.vx = state_.ball.vy = 0;
  }
  measure();
  // What is in the way slows the motors down, else wheels at full speed hammered on it a thousand times a second.
  for (std::size_t i = 0; i < driven.size(); ++i) {
    const SimRobot& robot = state_.robots[i];
    const FieldPoint pushed = robot.at - driven[i];
    const double change = (pushed.x * std::cos(robot.theta) + pushed.y * std::sin(robot.theta)) / kTick;
    for (double* wheel : {&drives_[i].left, &drives_[i].right})
      *wheel = std::clamp(*wheel + change, -options_.max_wheel_speed, options_.max_wheel_speed);
  }
  referee(events);
}

void World::drive(std::size_t i) {
  SimRobot& robot = state_.robots[i];
  Drive& drive = drives_[i];
  const double change = options_.max_wheel_acceleration * kTick, most = options_.max_wheel_speed;
  const auto towards = [&](double speed, double wanted) {
    // A command that is no number is none.
    const double target = std::isfinite(wanted) ? std::clamp(wanted, -most, most) : 0;
    return speed + std::clamp(target - speed, -change, change);
  };
  drive.left = towards(drive.left, drive.command.left);
  drive.right = towards(drive.right, drive.command.right);
  if (options_.slip_sigma > 0) {
    std::normal_distribution<double> normal;
    const double forget = kTick / options_.slip_correlation_s, grow = options_.slip_sigma * std::sqrt(2 * forget);
    drive.left_slip += grow * normal(drive.random) - forget * drive.left_slip;
    drive.right_slip += grow * normal(drive.random) - forget * drive.right_slip;
  }
  const double base = options_.wheel_base * 2 * robot.radius;
  const auto roll = [&](double left, double right, double& x, double& y, double& theta) {
    const double way = (left + right) / 2 * kTick, turn = (right - left) / base * kTick;
    x += way * std::cos(theta + turn / 2);
    y += way * std::sin(theta + turn / 2);
    theta += turn;
    return turn / kTick;
  };
  roll(drive.left, drive.right, drive.odometry_x, drive.odometry_y, drive.odometry_theta);
  robot.turn = roll(drive.left * drive.left_scale * (1 - drive.left_slip),
                    drive.right * drive.right_scale * (1 - drive.right_slip), robot.at.x, robot.at.y, robot.theta);
  robot.theta = wrap_angle(robot.theta);
}

void World::push_robots_apart() {
  for (int round = 0; round < kRounds; ++round) {
    bool is_moved = false;
    for (std::size_t a = 0; a < state_.robots.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        SimRobot &one = state_.robots[a], &two = state_.robots[b];
        const FieldPoint away = one.at - two.at;
        const double gap = norm(away), least = one.radius + two.radius;
        if (gap >= least || gap <= 0) continue;
        const FieldPoint half = (least - gap + kGap) / 2 / gap * away;
        one.at = one.at + half;
        two.at = two.at - half;
        is_moved = true;
      }
    for (SimRobot& robot : state_.robots)
      for (const Barrier& barrier : barriers_)
        if (const auto push = push_out(robot.at, robot.radius, barrier)) {
          robot.at = robot.at + (push->depth + kGap) * push->normal;
          is_moved = true;
        }
    if (!is_moved) return;
  }
}

bool World::are_robots_apart() const {
  for (std::size_t a = 0; a < state_.robots.size(); ++a) {
    const SimRobot& one = state_.robots[a];
    for (std::size_t b = 0; b < a; ++b)
      if (distance(one.at, state_.robots[b].at) < one.radius + state_.robots[b].radius - kTouch) return false;
    for (const Barrier& barrier : barriers_)
      if (push_out(one.at, one.radius - kTouch, barrier)) return false;
  }
  return true;
}

void World::kick(std::size_t i) {
  Drive& drive = drives_[i];
  const SimRobot& robot = state_.robots[i];
  if (!drive.command.is_kick || state_.t - drive.kicked_at < options_.kick_pause_s) return;
  const FieldPoint to = state_.ball.at - robot.at;
  if (norm(to) > robot.radius + state_.ball.radius + options_.kick_reach) return;
  if (std::abs(wrap_angle(bearing(to) - robot.theta)) > radians(options_.guide_deg)) return;
  std::normal_distribution<double> normal;
  const double direction = robot.theta + radians(options_.kick_sigma_deg) * normal(drive.random);
  state_.ball.vx = drive.vx + options_.kick_speed * std::cos(direction);
  state_.ball.vy = drive.vy + options_.kick_speed * std::sin(direction);
  drive.kicked_at = state_.t;
}

void World::roll_ball(std::vector<RefereeEvent>& events) {
  SimBall& ball = state_.ball;
  const auto steps = std::max(1, static_cast<int>(std::ceil(std::hypot(ball.vx, ball.vy) * kTick / (ball.radius / 4))));
  const double dt = kTick / steps;
  for (int k = 0; k < steps; ++k) {
    const FieldPoint before = ball.at;
    const double speed = std::hypot(ball.vx, ball.vy), slower = std::max(speed - options_.ball_friction * dt, 0.);
    if (speed > 0) {
      // Exact, also within the step in which it comes to rest.
      const double way = (speed * speed - slower * slower) / (2 * options_.ball_friction);
      ball.at = ball.at + FieldPoint{way / speed * ball.vx, way / speed * ball.vy};
      ball.vx *= slower / speed;
      ball.vy *= slower / speed;
    }
    for (std::size_t i = 0; i < state_.robots.size(); ++i) bounce_off_robot(i, dt);
    bounce_ball();
    if (is_goal(before, events)) return;
  }
}

/// Off what stands. A ball in a corner touches two at once.
void World::bounce_ball() {
  SimBall& ball = state_.ball;
  for (int round = 0; round < 3; ++round) {
    bool is_moved = false;
    for (const Barrier& barrier : barriers_) {
      const auto push = push_out(ball.at, ball.radius, barrier);
      if (!push) continue;
      is_moved = true;
      ball.at = ball.at + (push->depth + kGap) * push->normal;
      const double into = ball.vx * push->normal.x + ball.vy * push->normal.y;
      if (into >= 0) continue;
      ball.vx -= (1 + options_.wall_restitution) * into * push->normal.x;
      ball.vy -= (1 + options_.wall_restitution) * into * push->normal.y;
    }
    if (!is_moved) return;
  }
}

void World::bounce_off_robot(std::size_t i, double dt) {
  SimBall& ball = state_.ball;
  const SimRobot& robot = state_.robots[i];
  const FieldPoint away = ball.at - robot.at;
  const double gap = norm(away), least = robot.radius + ball.radius;
  if (gap >= least + kTouch || gap <= 0) return;
  const FieldPoint normal = 1 / gap * away, along{-normal.y, normal.x};
  const bool is_guided = std::abs(wrap_angle(bearing(away) - robot.theta)) <= radians(options_.guide_deg);
  if (gap < least) ball.at = ball.at + (least - gap + kGap) * normal;
  const FieldPoint relative{ball.vx - drives_[i].vx, ball.vy - drives_[i].vy};
  const double into = dot(relative, normal);
  if (into < 0) {
    const double back = (is_guided ? 1 : 1 + options_.robot_restitution) * into;
    ball.vx -= back * normal.x;
    ball.vy -= back * normal.y;
  }
  if (!is_guided) return;
  // The front turns with the robot and takes the ball along.
  const double across = dot(relative, along) - robot.turn * least;
  const double change =
      std::min(std::abs(across) * (1 - std::exp(-dt / options_.guide_time_s)), options_.guide_acceleration * dt);
  ball.vx -= std::copysign(change, across) * along.x;
  ball.vy -= std::copysign(change, across) * along.y;
}

bool World::is_ball_clear() const {
  const SimBall& ball = state_.ball;
  for (const SimRobot& robot : state_.robots)
    if (distance(robot.at, ball.at) < robot.radius + ball.radius - kTouch) return false;
  for (const Barrier& barrier : barriers_)
    if (push_out(ball.at, ball.radius - kTouch, barrier)) return false;
  return true;
}

bool World::is_goal(FieldPoint before, std::vector<RefereeEvent>& events) {
  const FieldPoint at = state_.ball.at;
  for (const FieldModel::Goal& goal : field_.goals) {
    const double side = end_of(goal.side), line = field_.length / 2;
    if (!(side * before.x <= line && side * at.x > line && std::abs(at.y) < goal.width / 2)) continue;
    const Team scorer = own_goal(Team::cyan) == goal.side ? Team::magenta : Team::cyan;
    (scorer == Team::cyan ? score_.cyan : score_.magenta) += 1;
    events.push_back({state_.t, RefereeCall::goal, scorer});
    kick_off(other(scorer), events);
    return true;
  }
  return false;
}

void World::referee(std::vector<RefereeEvent>& events) {
  const SimBall& ball = state_.ball;
  const FieldPoint at = ball.at;
  if (!field_.walls &&
      (std::abs(at.x) > field_.length / 2 + ball.radius || std::abs(at.y) > field_.width / 2 + ball.radius)) {
    put_ball_to_free_spot(at);
    events.push_back({state_.t, RefereeCall::ball_out, Team::unknown});
    return;
  }
  if (distance(at, ball_stays_at_) > options_.stuck_distance * field_.length) {
    ball_stays_at_ = at;
    ball_stays_since_ = state_.t;
  } else if (state_.t - ball_stays_since_ >= options_.stuck_s) {
    put_ball_to_free_spot(at);
    events.push_back({state_.t, RefereeCall::stuck_ball, Team::unknown});
  }
}

}  // namespace tassilo
