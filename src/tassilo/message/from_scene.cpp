#include "tassilo/message/from_scene.h"

#include <cmath>
#include <limits>

#include "tassilo/base/contract.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

ros::Header robot_header(ros::Time stamp, const MessageContext& context) {
  return {stamp, robot_frame_id(context.robot, "base_link")};
}

ros::Point point_of(FloorPoint point, double z = 0) { return {point.x, point.y, z}; }

std::array<double, 4> row_major(const Eigen::Matrix2d& m) { return {m(0, 0), m(0, 1), m(1, 0), m(1, 1)}; }

/// Of x, y and theta, among x, y, z and rotations about X, Y, Z.
std::array<double, 36> spatial(const Eigen::Matrix3d& planar) {
  constexpr std::array<std::size_t, 3> at{0, 1, 5};
  std::array<double, 36> covariance{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      covariance[6 * at[i] + at[j]] = planar(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return covariance;
}

std::uint8_t team_number(Team team) {
  switch (team) {
    case Team::cyan:
      return 1;
    case Team::magenta:
      return 2;
    case Team::unknown:
      break;
  }
  return 0;
}

std::uint8_t state_number(SectorState state) {
  switch (state) {
    case SectorState::free:
      return 1;
    case SectorState::blocked:
      return 2;
    case SectorState::unseen:
      break;
  }
  return 0;
}

std::uint8_t kind_number(PoseKind kind) {
  switch (kind) {
    case PoseKind::two_lines:
      return 1;
    case PoseKind::one_line:
      return 2;
    case PoseKind::predicted:
      return 3;
    case PoseKind::goal:
      return 4;
    case PoseKind::model:
      return 5;
    case PoseKind::start:
      break;
  }
  return 6;
}

ros::TransformStamped transform(ros::Time stamp, const std::string& parent, const std::string& child, FloorPoint at,
                                double theta) {
  return {{stamp, parent}, child, {{at.x, at.y, 0}, quaternion_of(theta)}};
}

}  // namespace

ros::Time ros_time(double t) {
  expects(t >= 0 && t < std::numeric_limits<std::int32_t>::max(), "a time since the UNIX epoch");
  auto seconds = static_cast<std::int64_t>(std::floor(t));
  auto nanoseconds = std::llround((t - std::floor(t)) * 1e9);
  if (nanoseconds == 1'000'000'000) {
    ++seconds;
    nanoseconds = 0;
  }
  return {static_cast<std::int32_t>(seconds), static_cast<std::uint32_t>(nanoseconds)};
}

std::int64_t nanoseconds_of(const ros::Time& time) { return time.sec * std::int64_t{1'000'000'000} + time.nanosec; }

double seconds_of(const ros::Time& time) { return time.sec + 1e-9 * time.nanosec; }

ros::Quaternion quaternion_of(double theta) { return {0, 0, std::sin(theta / 2), std::cos(theta / 2)}; }

double heading_of(const ros::Quaternion& q) {
  return std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
}

std::string robot_frame_id(int robot, std::string_view frame) {
  return std::string("robot").append(std::to_string(robot)).append("/").append(frame);
}

ros::PoseWithCovarianceStamped pose_message(const PoseSeen& pose, ros::Time stamp) {
  ros::PoseWithCovarianceStamped message;
  message.header = {stamp, "map"};
  message.pose.pose = {{pose.x, pose.y, 0}, quaternion_of(pose.theta)};
  message.pose.covariance =
      spatial(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.covariance.data()));
  return message;
}

ros::LaserScan scan_message(const FreeSpace& space, ros::Time stamp, const MessageContext& context) {
  ros::LaserScan message;
  message.header = {stamp, robot_frame_id(context.robot, "free_space")};
  message.angle_min = static_cast<float>(space.angle_min);
  message.angle_increment = static_cast<float>(space.angle_increment);
  const std::size_t steps = space.ranges.empty() ? 0 : space.ranges.size() - 1;
  message.angle_max = static_cast<float>(space.angle_min + static_cast<double>(steps) * space.angle_increment);
  message.range_max = static_cast<float>(context.free_space_range);
  message.ranges.reserve(space.ranges.size());
  for (std::size_t i = 0; i < space.ranges.size(); ++i) {
    float range = std::numeric_limits<float>::quiet_NaN();
    if (space.states[i] == SectorState::blocked) range = static_cast<float>(space.ranges[i]);
    if (space.states[i] == SectorState::free && space.ranges[i] >= context.free_space_range)
      range = std::numeric_limits<float>::infinity();
    message.ranges.push_back(range);
  }
  return message;
}

msgs::FreeSpace free_space_message(const FreeSpace& space, ros::Time stamp, const MessageContext& context) {
  msgs::FreeSpace message;
  message.header = robot_header(stamp, context);
  message.origin = point_of(space.origin);
  message.angle_min = space.angle_min;
  message.angle_increment = space.angle_increment;
  message.range_max = context.free_space_range;
  for (std::size_t i = 0; i < space.ranges.size(); ++i) {
    const bool is_seen = space.states[i] != SectorState::unseen;
    message.ranges.push_back(is_seen ? static_cast<float>(space.ranges[i]) : std::numeric_limits<float>::quiet_NaN());
    message.states.push_back(state_number(space.states[i]));
  }
  return message;
}

msgs::BallArray balls_message(const Scene& scene, ros::Time stamp, const MessageContext& context) {
  msgs::BallArray message{robot_header(stamp, context), {}};
  for (const Ball& ball : scene.balls) {
    if (!ball.floor) continue;
    message.balls.push_back({point_of(ball.floor->position.mean, context.ball_radius),
                             row_major(ball.floor->position.covariance), ball.floor->bounds.near,
                             ball.floor->bounds.far, ball.confidence});
  }
  return message;
}

msgs::GoalArray goals_message(const Scene& scene, ros::Time stamp, const MessageContext& context) {
  msgs::GoalArray message{robot_header(stamp, context), {}};
  for (const Goal& goal : scene.goals) {
    if (!goal.bearing) continue;
    msgs::Goal told;
    told.color = goal.color == GoalColor::blue ? 1 : 0;
    told.bearing = *goal.bearing;
    told.center = goal.position ? point_of(*goal.position) : ros::Point{kUnknown, kUnknown, 0};
    for (const GoalPost& post : goal.posts)
      told.posts.push_back({static_cast<std::uint8_t>(post.side == PostSide::right ? 1 : 0), point_of(post.position)});
    message.goals.push_back(std::move(told));
  }
  return message;
}

msgs::RobotArray robots_message(const Scene& scene, ros::Time stamp, const MessageContext& context) {
  msgs::RobotArray message{robot_header(stamp, context), {}};
  for (const RobotSeen& robot : scene.robots) {
    if (!robot.floor) continue;
    const RobotOnFloor& floor = *robot.floor;
    message.robots.push_back({team_number(robot.team), point_of(floor.nearest.mean),
                              row_major(floor.nearest.covariance), floor.bounds.near, floor.bounds.far,
                              point_of(floor.center), floor.width});
  }
  return message;
}

msgs::LineArray lines_message(const Scene& scene, ros::Time stamp, const MessageContext& context) {
  msgs::LineArray message{robot_header(stamp, context), {}, {}};
  for (const LineSeen& line : scene.lines) {
    if (!line.floor) continue;
    message.lines.push_back({static_cast<std::uint8_t>(line.kind == LineKind::boundary ? 1 : 0),
                             point_of(line.floor->first), point_of(line.floor->second), line.model});
  }
  for (const CircleSeen& circle : scene.circles) message.circles.push_back({point_of(circle.center), circle.radius});
  return message;
}

msgs::TrackArray tracks_message(const Scene& scene, ros::Time stamp, const MessageContext& context) {
  msgs::TrackArray message{robot_header(stamp, context), {}};
  for (const TrackSeen& track : scene.tracks) {
    const bool is_ball = track.kind == TrackKind::ball;
    message.tracks.push_back({track.id,
                              static_cast<std::uint8_t>(is_ball ? 0 : 1),
                              team_number(track.team),
                              {track.x, track.y, is_ball ? context.ball_radius : 0},
                              {track.vx, track.vy, 0},
                              track.covariance,
                              track.age});
  }
  return message;
}

std::optional<ros::Odometry> odometry_message(const Odometry& odometry, double t, ros::Time stamp,
                                              const MessageContext& context) {
  const std::optional<OdometrySample> now = odometry.at(t);
  if (!now) return std::nullopt;
  ros::Odometry message;
  message.header = {stamp, robot_frame_id(context.robot, "odom")};
  message.child_frame_id = robot_frame_id(context.robot, "base_link");
  message.pose.pose = {{now->x, now->y, 0}, quaternion_of(now->theta)};
  // Long against the noise of single samples, short against what a robot changes its speed in.
  constexpr double dt = 0.1;  // [s]
  const RobotMotion motion = robot_motion(&odometry, t - dt, t, context.motion);
  if (motion.is_measured) {
    // Along the axes of the robot as it is now, not as it was.
    const double c = std::cos(motion.theta), s = std::sin(motion.theta);
    message.twist.twist.linear = {(c * motion.x + s * motion.y) / dt, (c * motion.y - s * motion.x) / dt, 0};
    message.twist.twist.angular = {0, 0, motion.theta / dt};
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn.topLeftCorner<2, 2>() << c, s, -s, c;
    message.twist.covariance = spatial(turn * motion.covariance * turn.transpose() / (dt * dt));
  }
  return message;
}

ros::TFMessage transforms_message(const Scene& scene, const std::optional<OdometrySample>& odometry, ros::Time stamp,
                                  const MessageContext& context) {
  const std::string base = robot_frame_id(context.robot, "base_link");
  const std::string odom = robot_frame_id(context.robot, "odom");
  ros::TFMessage message;
  if (odometry) message.transforms.push_back(transform(stamp, odom, base, {odometry->x, odometry->y}, odometry->theta));
  // A frame has one parent: that of a robot with odometry does not change when odometry is missing for a moment.
  if (scene.pose && (odometry || !context.has_odometry)) {
    double theta = scene.pose->theta;
    Point2<RobotFrame> at{scene.pose->x, scene.pose->y};
    if (odometry) {
      theta -= odometry->theta;
      const double c = std::cos(theta), s = std::sin(theta);
      at = {at.x - c * odometry->x + s * odometry->y, at.y - s * odometry->x - c * odometry->y};
    }
    message.transforms.push_back(transform(stamp, "map", odometry ? odom : base, at, theta));
  }
  if (scene.free_space)
    message.transforms.push_back(
        transform(stamp, base, robot_frame_id(context.robot, "free_space"), scene.free_space->origin, 0));
  return message;
}

msgs::TeamState team_state_message(const Scene& scene, ros::Time stamp, const MessageContext& context) {
  msgs::TeamState message;
  message.header = robot_header(stamp, context);
  message.robot = static_cast<std::uint8_t>(context.robot);
  message.team = team_number(context.team);
  if (scene.pose) {
    message.pose_kind = kind_number(scene.pose->kind);
    message.pose_age = scene.pose->age;
    message.pose_is_mirrored = scene.pose->mirror;
  }
  return message;
}

}  // namespace tassilo
