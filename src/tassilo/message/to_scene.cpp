#include "tassilo/message/to_scene.h"

#include <cmath>

#include "tassilo/message/from_scene.h"

namespace tassilo {
namespace {

FloorPoint floor_point(const ros::Point& point) { return {point.x, point.y}; }

Gaussian2<RobotFrame> gaussian(const ros::Point& mean, const std::array<double, 4>& covariance) {
  Gaussian2<RobotFrame> value{floor_point(mean), {}};
  value.covariance << covariance[0], covariance[1], covariance[2], covariance[3];
  return value;
}

}  // namespace

Team team_from(std::uint8_t number) {
  if (number == 1) return Team::cyan;
  if (number == 2) return Team::magenta;
  return Team::unknown;
}

std::optional<PoseKind> pose_kind_from(std::uint8_t number) {
  switch (number) {
    case 1:
      return PoseKind::two_lines;
    case 2:
      return PoseKind::one_line;
    case 3:
      return PoseKind::predicted;
    case 4:
      return PoseKind::goal;
    case 5:
      return PoseKind::model;
    case 6:
      return PoseKind::start;
    default:
      return std::nullopt;
  }
}

PoseSeen pose_from(const ros::PoseWithCovarianceStamped& message) {
  PoseSeen pose;
  pose.x = message.pose.pose.position.x;
  pose.y = message.pose.pose.position.y;
  pose.theta = heading_of(message.pose.pose.orientation);
  constexpr std::array<std::size_t, 3> at{0, 1, 5};  // x, y and the rotation about Z
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) pose.covariance[3 * i + j] = message.pose.covariance[6 * at[i] + at[j]];
  return pose;
}

void add_state(PoseSeen& pose, const msgs::TeamState& state) {
  pose.kind = pose_kind_from(state.pose_kind).value_or(pose.kind);
  pose.age = state.pose_age;
  pose.mirror = state.pose_is_mirrored;
}

RecycledVector<Ball> balls_from(const msgs::BallArray& message) {
  RecycledVector<Ball> balls;
  for (const msgs::Ball& told : message.balls) {
    Ball ball;
    ball.confidence = told.confidence;
    ball.floor = BallOnFloor{gaussian(told.center, told.covariance), {told.near, told.far}};
    balls.push_back(ball);
  }
  return balls;
}

RecycledVector<Goal> goals_from(const msgs::GoalArray& message) {
  RecycledVector<Goal> goals;
  for (const msgs::Goal& told : message.goals) {
    Goal goal;
    goal.color = told.color == 1 ? GoalColor::blue : GoalColor::yellow;
    goal.bearing = told.bearing;
    if (!std::isnan(told.center.x)) goal.position = floor_point(told.center);
    for (const msgs::GoalPost& post : told.posts)
      goal.posts.push_back({post.side == 1 ? PostSide::right : PostSide::left, floor_point(post.base)});
    goals.push_back(std::move(goal));
  }
  return goals;
}

RecycledVector<RobotSeen> robots_from(const msgs::RobotArray& message) {
  RecycledVector<RobotSeen> robots;
  for (const msgs::Robot& told : message.robots) {
    RobotSeen robot;
    robot.team = team_from(told.team);
    robot.floor = RobotOnFloor{
        gaussian(told.nearest, told.covariance), {told.near, told.far}, floor_point(told.center), told.width};
    robots.push_back(robot);
  }
  return robots;
}

RecycledVector<LineSeen> lines_from(const msgs::LineArray& message) {
  RecycledVector<LineSeen> lines;
  for (const msgs::Line& told : message.lines) {
    LineSeen line;
    line.kind = told.kind == 1 ? LineKind::boundary : LineKind::line;
    line.floor = {floor_point(told.p), floor_point(told.q)};
    line.model = told.model;
    lines.push_back(std::move(line));
  }
  return lines;
}

RecycledVector<CircleSeen> circles_from(const msgs::LineArray& message) {
  RecycledVector<CircleSeen> circles;
  for (const msgs::Circle& told : message.circles) circles.push_back({floor_point(told.center), told.radius});
  return circles;
}

RecycledVector<TrackSeen> tracks_from(const msgs::TrackArray& message) {
  RecycledVector<TrackSeen> tracks;
  for (const msgs::Track& told : message.tracks) {
    TrackSeen track;
    track.id = told.id;
    track.kind = told.kind == 1 ? TrackKind::robot : TrackKind::ball;
    track.team = team_from(told.team);
    track.x = told.position.x;
    track.y = told.position.y;
    track.vx = told.velocity.x;
    track.vy = told.velocity.y;
    track.covariance = told.covariance;
    track.age = told.age;
    tracks.push_back(track);
  }
  return tracks;
}

FreeSpace free_space_from(const msgs::FreeSpace& message) {
  constexpr std::array states{SectorState::unseen, SectorState::free, SectorState::blocked};
  FreeSpace space;
  space.origin = floor_point(message.origin);
  space.angle_min = message.angle_min;
  space.angle_increment = message.angle_increment;
  for (std::size_t i = 0; i < message.ranges.size(); ++i) {
    space.ranges.push_back(message.ranges[i]);
    space.states.push_back(states.at(message.states[i]));
  }
  return space;
}

}  // namespace tassilo
