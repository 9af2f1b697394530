#include "tassilo/behavior/internal/situation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tassilo/base/contract.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

/// An older picture tells of a place the robot has left long ago. [s]
constexpr double kMaxPictureAge = 0.5;
/// Beyond this a ball's place says nothing to go by. One standard deviation. [m]
constexpr double kMaxBallSigma = 1;
/// And the robot's own. [m]
constexpr double kMaxPoseSigma = 0.5;
/// A mate that is told nearer to one that is seen is that one. [m]
constexpr double kSame = 0.5;

std::optional<FieldFromRobot> usable_pose(const Scene& scene, const PlayerOptions& options) {
  if (!scene.pose || scene.pose->mirror || scene.pose->age > options.max_pose_age) return std::nullopt;
  const double variance = std::max(scene.pose->covariance[0], scene.pose->covariance[4]);
  if (!(variance <= kMaxPoseSigma * kMaxPoseSigma)) return std::nullopt;
  return make_pose2<FieldFrame, RobotFrame>(scene.pose->x, scene.pose->y, scene.pose->theta);
}

void take_field(Situation& now, const PlayerInput& input, const PlayerOptions& options) {
  const FieldModel& field = *input.field;
  const double side = input.own_goal == GoalSide::plus_x ? 1 : -1;
  now.own_goal = {side * field.length / 2, 0};
  now.other_goal = {-side * field.length / 2, 0};
  now.goal_half_width = 0.15 * field.width;
  for (const FieldModel::Goal& goal : field.goals) now.goal_half_width = goal.width / 2;
  now.arena = field_extent(field);
  // Lines may be crossed by half a robot; walls not, and in a goal there is nothing to do for a robot.
  const double inside = field.walls ? options.radius : 0;
  now.arena.x = {std::max(now.arena.x.low, -field.length / 2) + inside,
                 std::min(now.arena.x.high, field.length / 2) - inside};
  now.arena.y = {now.arena.y.low + inside, now.arena.y.high - inside};
}

void take_ball(Situation& now, const Scene* scene, const PlayerInput& input,
               const Pose2<RobotFrame, RobotFrame>& now_from_then, double picture_age, const PlayerOptions& options) {
  const auto turned = [&](FloorPoint v) {
    return FloorPoint{now_from_then.cos * v.x - now_from_then.sin * v.y,
                      now_from_then.sin * v.x + now_from_then.cos * v.y};
  };
  if (scene != nullptr) {
    const auto track = std::ranges::find(scene->tracks, TrackKind::ball, &TrackSeen::kind);
    if (track != scene->tracks.end()) {
      now.ball = now_from_then * FloorPoint{track->x, track->y};
      now.ball_velocity = turned({track->vx, track->vy});
      now.ball_age = track->age + picture_age;
    } else if (!scene->balls.empty() && scene->balls[0].floor) {
      now.ball = now_from_then * scene->balls[0].floor->position.mean;
      now.ball_age = picture_age;
    }
    if (now.ball) {
      now.ball = rolled(*now.ball, now.ball_velocity, picture_age, options.ball_friction);
      now.is_ball_seen = true;
      return;
    }
  }
  if (!input.ball || !now.pose || input.ball->age > options.max_team_age) return;
  const Eigen::Matrix2d& covariance = input.ball->position.covariance;
  if (!(std::max(covariance(0, 0), covariance(1, 1)) <= kMaxBallSigma * kMaxBallSigma)) return;
  const FieldPoint at = input.ball->position.mean;
  const FloorPoint start = now.in_robot(at);
  now.ball_velocity = now.in_robot(at + FieldPoint{input.ball->vx, input.ball->vy}) - start;
  now.ball = rolled(start, now.ball_velocity, input.ball->age, options.ball_friction);
  now.ball_age = input.ball->age;
}

/// Was floor seen where the ball should lie?
bool is_floor_seen_at(const Situation& now, FloorPoint ball) {
  constexpr double kAround = 4 * std::numbers::pi / 180, kBehind = 0.4;
  return std::ranges::any_of(now.floor, [&](const SeenFloor& floor) {
    return std::abs(wrap_angle(bearing(floor.end) - bearing(ball))) < kAround && norm(floor.end) > norm(ball) + kBehind;
  });
}

/// A ball that nobody tells of lies where it was, as far as one knows.
void remember_ball(Situation& now, const PlayerState& before, const PlayerOptions& options) {
  if (now.ball || !now.pose || !before.ball_was_at || now.t - before.ball_known_at > options.max_team_age) return;
  const FloorPoint ball = now.in_robot(*before.ball_was_at);
  if (is_floor_seen_at(now, ball)) return;
  now.ball = ball;
  now.ball_age = now.t - before.ball_known_at;
  now.is_ball_remembered = true;
}

}  // namespace

FieldPoint Situation::clamped(FieldPoint p) const {
  return {std::clamp(p.x, arena.x.low, arena.x.high), std::clamp(p.y, arena.y.low, arena.y.high)};
}

FloorPoint rolled(FloorPoint ball, FloorPoint velocity, double dt, double friction) {
  const double speed = norm(velocity);
  if (speed < 1e-6) return ball;
  const double rolls = std::min(dt, speed / friction);
  return ball + (rolls - friction * rolls * rolls / (2 * speed)) * velocity;
}

Situation situation(const PlayerState& before, const PlayerInput& input, const PlayerOptions& options) {
  expects(input.field != nullptr, "play: a field");
  Situation now;
  now.t = input.t;
  now.ball_radius = input.field->ball.radius.middle();
  take_field(now, input, options);
  const Scene* scene = input.scene;
  const double picture_age = scene != nullptr ? std::max(input.t - scene->t, 0.) : 0;
  if (picture_age > kMaxPictureAge) scene = nullptr;
  const double turned = before.turn_rate * picture_age, way = before.speed * picture_age;
  const auto then_from_now =
      make_pose2<RobotFrame, RobotFrame>(way * std::cos(turned / 2), way * std::sin(turned / 2), turned);
  const auto now_from_then = inverse(then_from_now);
  if (scene != nullptr)
    if (const auto pose = usable_pose(*scene, options)) now.pose = *pose * then_from_now;
  take_ball(now, scene, input, now_from_then, picture_age, options);

  if (scene != nullptr) {
    for (const TrackSeen& track : scene->tracks)
      if (track.kind == TrackKind::robot)
        now.others.push_back({now_from_then * FloorPoint{track.x, track.y}, options.radius,
                              track.team == input.team && input.team != Team::unknown});
    if (now.others.empty())
      for (const RobotSeen& robot : scene->robots)
        if (robot.floor)
          now.others.push_back({now_from_then * robot.floor->center, options.radius,
                                robot.team == input.team && input.team != Team::unknown});
    if (scene->free_space) {
      const FreeSpace& space = *scene->free_space;
      for (std::size_t i = 0; i < space.ranges.size(); ++i) {
        if (space.states[i] == SectorState::unseen) continue;
        const double angle = space.angle_min + static_cast<double>(i) * space.angle_increment;
        const FloorPoint end = space.origin + space.ranges[i] * FloorPoint{std::cos(angle), std::sin(angle)};
        now.floor.push_back({now_from_then * end, space.states[i] == SectorState::blocked});
      }
    }
    const GoalColor color_of_other = [&] {
      for (const FieldModel::Goal& goal : input.field->goals)
        if (goal.side != input.own_goal) return goal.color;
      return input.own_goal == GoalSide::minus_x ? GoalColor::blue : GoalColor::yellow;
    }();
    for (const Goal& goal : scene->goals)
      if (goal.color == color_of_other && goal.position) now.goal_seen = now_from_then * *goal.position;
  }
  remember_ball(now, before, options);
  if (now.pose)
    for (const Teammate& mate : input.mates) {
      if (!mate.pose || mate.age > options.max_team_age / 2) continue;
      const FloorPoint at = now.in_robot({mate.pose->x, mate.pose->y});
      const auto is_same = [&](const OtherRobot& other) { return distance(other.at, at) < kSame; };
      if (std::ranges::none_of(now.others, is_same)) now.others.push_back({at, options.radius, true});
    }
  return now;
}

}  // namespace tassilo
