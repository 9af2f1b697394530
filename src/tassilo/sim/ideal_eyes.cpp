#include "tassilo/sim/ideal_eyes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/base/option_check.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {
namespace {

/// Sectors of the free space. [rad]
constexpr double kSector = 2 * std::numbers::pi / 180;

/// Distance from the origin to a disc along a direction; huge when it is missed.
double ray_to_disc(FloorPoint at, double radius, FloorPoint unit) {
  const double along = dot(at, unit), across = cross(unit, at);
  if (along <= 0 || std::abs(across) >= radius) return 1e9;
  return std::max(along - std::sqrt(radius * radius - across * across), 0.);
}
double ray_to_barrier(FloorPoint p, FloorPoint q, FloorPoint unit) {
  const FloorPoint along = q - p;
  const double spread = cross(unit, along);
  if (std::abs(spread) < 1e-12) return 1e9;
  const double way = cross(p, along) / spread, share = cross(p, unit) / spread;
  return way >= 0 && share >= 0 && share <= 1 ? way : 1e9;
}

}  // namespace

void EyesOptions::check() const {
  check_above("eyes.view_deg", view_deg, 0);
  if (!(view_deg <= 360)) throw Error("eyes.view_deg", "is " + std::to_string(view_deg) + ", must be <= 360");
  check_above("eyes.max_range", max_range, 0);
  check_at_least("eyes.distance_sigma", distance_sigma, 0);
  check_at_least("eyes.bearing_sigma_deg", bearing_sigma_deg, 0);
  if (!(miss >= 0 && miss <= 1)) throw Error("eyes.miss", "is " + std::to_string(miss) + ", must be 0..1");
  check_at_least("eyes.pose_sigma", pose_sigma, 0);
  check_at_least("eyes.pose_sigma_deg", pose_sigma_deg, 0);
  check_above("eyes.pose_correlation_s", pose_correlation_s, 0);
  check_above("eyes.lost_every_s", lost_every_s, 0);
  check_at_least("eyes.lost_s", lost_s, 0);
}

IdealEyes::IdealEyes(const EyesOptions& options, int robot) : options_(options), robot_(robot) {
  options_.check();
  std::seed_seq seeds{static_cast<std::uint32_t>(options_.seed), static_cast<std::uint32_t>(options_.seed >> 32),
                      static_cast<std::uint32_t>(robot), 0x65796573u};
  random_.seed(seeds);
}

Scene IdealEyes::see_black(const World& world) {
  Scene scene;
  scene.frame = frame_++;
  scene.t = world.state().t;
  return scene;
}

Scene IdealEyes::see(const World& world) {
  Scene scene = see_black(world);
  const double t = scene.t;
  expects(is_first_ || t >= seen_at_, "IdealEyes: time goes forward");
  const auto& robots = world.state().robots;
  const SimRobot* const me = find_robot(world.state(), robot_);
  if (me == nullptr) return scene;
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::exponential_distribution<double> waiting;
  const auto robot_from_field = inverse(pose_of(*me));

  // Pose: an error that lasts, and times in which there is none.
  const double dt = is_first_ ? 1e9 : t - seen_at_, keeps = std::exp(-dt / options_.pose_correlation_s);
  const double fresh = std::sqrt(1 - keeps * keeps);
  for (double* error : {&error_x_, &error_y_, &error_theta_}) *error = keeps * *error + fresh * normal(random_);
  if (is_first_) next_lost_ = t + options_.lost_every_s * waiting(random_);
  if (t >= next_lost_) {
    lost_until_ = t + options_.lost_s * waiting(random_);
    next_lost_ = lost_until_ + options_.lost_every_s * waiting(random_);
  }
  if (t >= lost_until_) {
    const double sigma = options_.pose_sigma, sigma_theta = radians(options_.pose_sigma_deg);
    PoseSeen pose{me->at.x + sigma * error_x_,
                  me->at.y + sigma * error_y_,
                  wrap_angle(me->theta + sigma_theta * error_theta_),
                  {},
                  PoseKind::two_lines,
                  0,
                  false};
    pose.covariance[0] = pose.covariance[4] = sigma * sigma;
    pose.covariance[8] = sigma_theta * sigma_theta;
    scene.pose = pose;
  }

  const auto is_in_view = [&](FloorPoint p) {
    return norm(p) <= options_.max_range && std::abs(bearing(p)) <= radians(options_.view_deg) / 2;
  };
  const auto is_hidden = [&](FloorPoint p, int by_all_but) {
    const FloorPoint unit = 1 / std::max(norm(p), 1e-9) * p;
    return std::ranges::any_of(robots, [&](const SimRobot& other) {
      return other.id != robot_ && other.id != by_all_but &&
             ray_to_disc(robot_from_field * other.at, other.radius, unit) < norm(p);
    });
  };
  const auto noisy = [&](FloorPoint p) {
    const double away = norm(p) * (1 + options_.distance_sigma * normal(random_));
    const double angle = bearing(p) + radians(options_.bearing_sigma_deg) * normal(random_);
    Gaussian2<RobotFrame> seen{{away * std::cos(angle), away * std::sin(angle)}};
    const double along = std::max(away * options_.distance_sigma, 0.005);
    const double across = std::max(away * radians(options_.bearing_sigma_deg), 0.005);
    Eigen::Matrix2d turn;
    turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    seen.covariance = turn * Eigen::Vector2d(along * along, across * across).asDiagonal() * turn.transpose();
    return seen;
  };
  const auto is_found = [&] { return uniform(random_) >= options_.miss; };

  const FloorPoint ball_at = robot_from_field * world.state().ball.at;
  const double ball_radius = world.state().ball.radius;
  if (is_in_view(ball_at) && !is_hidden(ball_at, -1) && is_found()) {
    Ball ball;
    ball.confidence = 0.9;
    ball.floor = BallOnFloor{noisy(ball_at), {}};
    const double away = norm(ball.floor->position.mean);
    ball.floor->bounds = {away * (1 - 2 * options_.distance_sigma), away * (1 + 2 * options_.distance_sigma)};
    scene.balls.push_back(ball);
  }
  for (const SimRobot& other : robots) {
    const FloorPoint at = robot_from_field * other.at;
    if (other.id == robot_ || !is_in_view(at) || is_hidden(at, other.id) || !is_found()) continue;
    RobotSeen robot;
    robot.team = other.team;
    const auto center = noisy(at);
    const FloorPoint nearest = std::max(norm(center.mean) - other.radius, 0.) / norm(center.mean) * center.mean;
    robot.floor = RobotOnFloor{{nearest, center.covariance}, {}, center.mean, 2 * other.radius};
    robot.floor->bounds = {norm(nearest), norm(nearest)};
    scene.robots.push_back(robot);
  }
  for (const FieldModel::Goal& goal : world.field().goals) {
    const double x = (goal.side == GoalSide::plus_x ? 1 : -1) * world.field().length / 2;
    const FloorPoint mouth = robot_from_field * FieldPoint{x, 0};
    if (!is_in_view(mouth) || is_hidden(mouth, -1) || !is_found()) continue;
    Goal seen;
    seen.color = goal.color;
    seen.position = noisy(mouth).mean;
    seen.bearing = bearing(*seen.position);
    scene.goals.push_back(seen);
  }

  FreeSpace space;
  space.angle_increment = kSector;
  const int half = static_cast<int>(radians(options_.view_deg) / 2 / kSector);
  space.angle_min = -half * kSector;
  for (int k = -half; k <= half; ++k) {
    const FloorPoint unit{std::cos(k * kSector), std::sin(k * kSector)};
    double range = 1e9;
    for (const SimRobot& other : robots)
      if (other.id != robot_) range = std::min(range, ray_to_disc(robot_from_field * other.at, other.radius, unit));
    for (const Barrier& barrier : world.barriers())
      range = std::min(range, ray_to_barrier(robot_from_field * barrier.p, robot_from_field * barrier.q, unit));
    range *= std::max(1 + 0.5 * options_.distance_sigma * normal(random_), 0.5);
    const double to_ball = ray_to_disc(ball_at, ball_radius, unit);
    const bool is_end_of_view = options_.max_range < range || to_ball < range;
    space.ranges.push_back(std::min({range, options_.max_range, to_ball}));
    space.states.push_back(is_end_of_view ? SectorState::free : SectorState::blocked);
  }
  scene.free_space = space;

  odometry_.add(world.odometry(robot_));
  const TrackOptions track_options{};
  const RobotMotion motion = robot_motion(&odometry_, is_first_ ? t : tracks_.t, t, MotionOptions{});
  if (is_first_) tracks_.t = t;
  const TrackObservation seen{scene.balls, scene.robots, nullptr, nullptr};
  tracks_ = track(tracks_, motion, seen, t, track_options);
  scene.tracks = told(tracks_, track_options);

  seen_at_ = t;
  is_first_ = false;
  return scene;
}

}  // namespace tassilo
