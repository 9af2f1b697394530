#include "tassilo/sim/script.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/base/option_check.h"
#include "tassilo/field/field_curves.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {
namespace {

constexpr double kStep = .005;  ///< [s]

/// Even values of a well mixed counter (splitmix64), the same with every standard library.
double next_unit(std::uint64_t& state) {
  state += 0x9E3779B97F4A7C15U;
  std::uint64_t v = state;
  v = (v ^ (v >> 30U)) * 0xBF58476D1CE4E5B9U;
  v = (v ^ (v >> 27U)) * 0x94D049BB133111EBU;
  return static_cast<double>((v ^ (v >> 31U)) >> 11U) * 0x1p-53;
}

class Script {
 public:
  Script(const FieldModel& field, const ScriptOptions& options)
      : options_(options), extent_(field_extent(field)), dice_(options.seed * 0x2545F4914F6CDD1DU + 7) {
    const double size = std::min(extent_.x.high - extent_.x.low, extent_.y.high - extent_.y.low);
    const Interval width = field.robots.width, height = field.robots.height;
    // Small fields have small robots, which are slower.
    pace_ = std::min(1., size / 4.);
    for (int k = 0; k <= options.others; ++k) {
      SimRobot robot;
      robot.id = (options.id + k) % 256;
      const Team rival = options.team == Team::magenta ? Team::cyan : Team::magenta;
      robot.team = k % 2 == 0 ? options.team : rival;
      robot.radius = (width.low + (width.high - width.low) * between(.2, .55)) / 2;
      robot.height = std::min(height.low + (height.high - height.low) * between(.1, .45), .62);
      rim_ = std::max(rim_, robot.radius + .05 * size);
      for (int attempt = 0; attempt < 200; ++attempt) {
        robot.at = somewhere();
        const bool free = std::ranges::none_of(state_.robots, [&](const SimRobot& other) {
          return distance(other.at, robot.at) < 1.3 * (other.radius + robot.radius) + .05 * size;
        });
        if (free) break;
      }
      robot.theta = between(-std::numbers::pi, std::numbers::pi);
      state_.robots.push_back(robot);
      goals_.push_back(somewhere());
    }
    state_.ball.radius = options.ball_radius > 0 ? options.ball_radius : field.ball.radius.middle();
    for (int attempt = 0; attempt < 200; ++attempt) {
      state_.ball.at = somewhere();
      const bool free = std::ranges::all_of(state_.robots, [&](const SimRobot& robot) {
        return distance(robot.at, state_.ball.at) > robot.radius + 3 * state_.ball.radius;
      });
      if (free) break;
    }
    SimRobot& first = state_.robots.front();
    first.theta = bearing(state_.ball.at - first.at) + between(-.3, .3);
  }

  const SimState& at(double t) {
    expects(t >= state_.t - 1e-9, "scripted_motion: time does not go back");
    while (state_.t + 1e-9 < t) step(std::min(kStep, t - state_.t));
    return state_;
  }

 private:
  double between(double low, double high) { return low + (high - low) * next_unit(dice_); }
  FieldPoint somewhere() {
    return {between(extent_.x.low + rim_, extent_.x.high - rim_), between(extent_.y.low + rim_, extent_.y.high - rim_)};
  }

  void step(double dt) {
    for (std::size_t k = 0; k < state_.robots.size(); ++k) drive(k, dt);
    for (std::size_t i = 0; i < state_.robots.size(); ++i)
      for (std::size_t j = i + 1; j < state_.robots.size(); ++j) part(state_.robots[i], state_.robots[j]);
    roll(dt);
    state_.t += dt;
  }

  void drive(std::size_t k, double dt) {
    SimRobot& robot = state_.robots[k];
    const bool looks = k == 0;
    const double most = (looks ? 1 : .5) * options_.speed * pace_;
    if (distance(robot.at, goals_[k]) < 1.5 * robot.radius) {
      goals_[k] = somewhere();
      // The one that looks goes for the ball every other time, others now and then.
      if (between(0, 1) < (looks ? .6 : .3)) {
        const FieldPoint near = state_.ball.at;
        goals_[k] = {std::clamp(near.x, extent_.x.low + rim_, extent_.x.high - rim_),
                     std::clamp(near.y, extent_.y.low + rim_, extent_.y.high - rim_)};
      }
    }
    const FieldPoint to = goals_[k] - robot.at;
    FieldPoint wanted = (1 / std::max(norm(to), 1e-6)) * to;
    for (const SimRobot& other : state_.robots) {
      if (other.id == robot.id) continue;
      const FieldPoint away = robot.at - other.at;
      const double gap = norm(away) - robot.radius - other.radius, reach = 2.5 * robot.radius;
      if (gap < reach) wanted = wanted + (1.6 * (1 - gap / reach) / std::max(norm(away), 1e-6)) * away;
    }
    const double error = wrap_angle(bearing(wanted) - robot.theta);
    const double turn = std::clamp(2.2 * error, -options_.turn, options_.turn);
    const double speed = most * std::max(0., std::cos(error)) * std::min(1., norm(wanted));
    const double blend = std::min(1., dt / .2);
    robot.turn += blend * (turn - robot.turn);
    robot.speed += blend * (speed - robot.speed);
    robot.theta = wrap_angle(robot.theta + .5 * dt * robot.turn);
    robot.at = robot.at + dt * robot.speed * FieldPoint{std::cos(robot.theta), std::sin(robot.theta)};
    robot.theta = wrap_angle(robot.theta + .5 * dt * robot.turn);
    robot.at = {std::clamp(robot.at.x, extent_.x.low + robot.radius, extent_.x.high - robot.radius),
                std::clamp(robot.at.y, extent_.y.low + robot.radius, extent_.y.high - robot.radius)};
  }

  static void part(SimRobot& a, SimRobot& b) {
    const FieldPoint between = b.at - a.at;
    const double overlap = a.radius + b.radius - norm(between);
    if (overlap <= 0) return;
    const FieldPoint push = (.5 * overlap / std::max(norm(between), 1e-6)) * between;
    a.at = a.at - push;
    b.at = b.at + push;
  }

  void roll(double dt) {
    SimBall& ball = state_.ball;
    const double slower = std::exp(-dt / 2.5);
    ball.vx *= slower;
    ball.vy *= slower;
    ball.at = ball.at + dt * FieldPoint{ball.vx, ball.vy};
    const auto bounce = [&](double& at, double& v, const Interval& bounds) {
      const double low = bounds.low + ball.radius, high = bounds.high - ball.radius;
      if ((at < low && v < 0) || (at > high && v > 0)) v = -.6 * v;
      at = std::clamp(at, low, high);
    };
    bounce(ball.at.x, ball.vx, extent_.x);
    bounce(ball.at.y, ball.vy, extent_.y);
    for (const SimRobot& robot : state_.robots) {
      const FieldPoint away = ball.at - robot.at;
      const double range = norm(away), least = robot.radius + ball.radius;
      if (range >= least) continue;
      const FieldPoint unit = (1 / std::max(range, 1e-6)) * away;
      ball.at = robot.at + least * unit;
      const double kick = .4 * pace_ + robot.speed;
      ball.vx = kick * unit.x;
      ball.vy = kick * unit.y;
    }
  }

  ScriptOptions options_;
  FieldExtent extent_;
  std::uint64_t dice_;
  double rim_ = 0, pace_ = 1;
  SimState state_;
  std::vector<FieldPoint> goals_;  ///< Where robots go.
};

}  // namespace

void ScriptOptions::check() const {
  check_at_least("script.others", others, 0);
  if (others > 20) throw Error("script.others", "is " + std::to_string(others) + ", must be <= 20");
  check_at_least("script.ball_radius", ball_radius, 0);
  check_finite("script.ball_radius", ball_radius);
  check_above("script.speed", speed, 0);
  check_above("script.turn", turn, 0);
  check_finite("script.speed", speed);
  check_finite("script.turn", turn);
  if (id < 0 || id > 255) throw Error("script.id", "is " + std::to_string(id) + ", must be 0 .. 255");
}

SimMotion scripted_motion(const FieldModel& field, const ScriptOptions& options) {
  options.check();
  return [script = std::make_shared<Script>(field, options)](double t) { return script->at(t); };
}

SimMotion scripted_stills(const FieldModel& field, const ScriptOptions& options) {
  options.check();
  return [field, options](double t) {
    const auto still = static_cast<std::uint64_t>(std::max(0., std::floor(t + .5)));
    ScriptOptions changed = options;
    changed.seed = options.seed * 1000 + still;
    SimState state = Script(field, changed).at(0);
    state.t = t;
    SimRobot& me = state.robots.front();
    const FieldExtent extent = field_extent(field);
    const std::uint64_t turn = still % 4;
    FieldPoint aim = state.ball.at;
    if (turn == 1 || turn == 2) aim = {turn == 1 ? extent.x.high : extent.x.low, 0};
    if (turn == 3 && state.robots.size() > 1) aim = state.robots[1 + still / 4 % (state.robots.size() - 1)].at;
    me.theta = bearing(aim - me.at);
    // The ball close by, so that its color is seen from near and far.
    const double ahead = me.radius + (turn == 0 ? 4 : 12) * state.ball.radius,
                 aside = (turn % 2 == 0 ? 2 : -5) * state.ball.radius;
    const FieldPoint near = pose_of(me) * FloorPoint{ahead + me.radius, aside};
    if (near.x > extent.x.low && near.x < extent.x.high && near.y > extent.y.low && near.y < extent.y.high)
      state.ball.at = near;
    return state;
  };
}

RobotMotion motion_between(const SimRobot& before, const SimRobot& after) {
  const auto robot_from_field = inverse(make_pose2<FieldFrame, RobotFrame>(before.at.x, before.at.y, before.theta));
  const FloorPoint to = robot_from_field * after.at;
  return {to.x, to.y, wrap_angle(after.theta - before.theta)};
}

SlippingWheels::SlippingWheels(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15U + 99) {
  scale_ = 1 + .03 * normal();
  turn_scale_ = 1 + .04 * normal();
}

double SlippingWheels::normal() {
  const double u = 1 - next_unit(state_), v = next_unit(state_);
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

RobotMotion SlippingWheels::measured(const RobotMotion& motion) {
  const double way = std::hypot(motion.dx, motion.dy);
  return {scale_ * motion.dx + (.0005 + .03 * way) * normal(), scale_ * motion.dy + (.0005 + .02 * way) * normal(),
          turn_scale_ * motion.dtheta + (.0005 + .03 * std::abs(motion.dtheta) + .01 * way) * normal()};
}

RenderOptions rendering_of(Difficulty difficulty, const FieldModel& field) {
  RenderOptions options;
  options.rays_per_side = 3;
  if (difficulty == Difficulty::easy) {
    options.shot_noise = .009;
    options.read_noise = .0015;
    options.vignetting = .1;
    options.blur_px = .4;
    options.carpet = .06;
    options.clutter = options.people = .15;
    return options;
  }
  options.rays_per_side = 2;
  options.sub_frames = 4;
  options.shutter = .012;
  if (difficulty == Difficulty::normal) return options;
  options.shot_noise = .035;
  options.read_noise = .006;
  options.vignetting = .4;
  options.blur_px = .9;
  options.shutter = .025;
  options.sub_frames = 6;
  options.clutter = options.people = 1;
  options.ball_colored_people = true;
  options.ambient = .25;
  // Daylight from one side, and hall lamps of which those on the far side are weak.
  const FieldExtent extent = field_extent(field);
  const double length = extent.x.high - extent.x.low, width = extent.y.high - extent.y.low;
  options.lamps.push_back({.x = 0,
                           .y = extent.y.high + .8 * width,
                           .z = std::clamp(.5 * width, 2.2, 5.),
                           .intensity = 2.2,
                           .temperature = 6200,
                           .radius = .9});
  for (const double x : {-.3, .3})
    for (const double y : {-.3, .3})
      options.lamps.push_back({.x = x * length,
                               .y = y * width,
                               .z = std::clamp(.45 * length, 3.2, 8.),
                               .intensity = y < 0 ? .5 : .9,
                               .temperature = 3600,
                               .radius = .3});
  return options;
}

}  // namespace tassilo
