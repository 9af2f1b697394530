#pragma once

// For tests only: what a robot would see of a field, without a camera.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tassilo/field/field_curves.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/localize/pose_fit.h"

namespace tassilo::test {

/// A walled field with two colored goals, or one of lines alone.
inline FieldModel plain_field(bool walls) {
  FieldModel field;
  field.name = "test";
  field.length = 8.22;
  field.width = 4.575;
  field.line_width = 0.035;
  field.halfway_line = true;
  field.circle_radius = 1;
  field.areas = {{1, 2.6}};
  field.touchlines = !walls;
  if (walls)
    field.walls = FieldModel::Walls{.color = "white", .height = 0.5, .x = {-4.11, 4.11}, .y = {-2.2875, 2.2875}};
  field.goals = {{GoalSide::plus_x, GoalColor::blue, 1.5, 0.9, 0.5},
                 {GoalSide::minus_x, GoalColor::yellow, 1.5, 0.9, 0.5}};
  return field;
}

struct SeenFromPose {
  std::vector<LineMark> marks;
  std::vector<Goal> goals;
  PoseObservation observation() const { return {marks, goals, nullptr}; }
};

/// What can be seen within a wedge of `half_angle` to both sides and `range`; each mark with noise of its sigma.
struct Sight {
  double half_angle = 0.7, range = 5;  ///< [rad, m]
  bool goals = true;
  unsigned seed = 1;
  double noise = 1;            ///< Times sigma.
  double eye_height = 0;       ///< [m] 0: marks do not say where they were seen from.
  double pitch = 0, roll = 0;  ///< Of a robot whose camera file has it level: front down, right side down. [rad]
};
/// Where a robot that is tilted, but has itself level, believes a place of the floor.
inline FloorPoint believed_level(FloorPoint p, const Sight& sight) {
  // The ray in the frame of the robot: not rolled, then not pitched.
  const double cp = std::cos(sight.pitch), sp = std::sin(sight.pitch), cr = std::cos(sight.roll),
               sr = std::sin(sight.roll);
  const double h = sight.eye_height;
  const double x = cp * p.x + sp * h, z = sp * p.x - cp * h;
  const double y = cr * p.y + sr * z, down = -(-sr * p.y + cr * z);
  return {h / down * x, h / down * y};
}
inline SeenFromPose seen_from(const FieldTarget& target, const FieldFromRobot& field_from_robot,
                              const Sight& sight = {}) {
  SeenFromPose seen;
  std::mt19937 random(sight.seed);
  std::normal_distribution<double> normal;
  const auto robot_from_field = inverse(field_from_robot);
  const auto visible = [&](FloorPoint p) {
    return norm(p) > 0.3 && norm(p) < sight.range && std::abs(bearing(p)) < sight.half_angle;
  };
  int number = 0;
  const auto add = [&](const std::vector<std::pair<FloorPoint, FloorPoint>>& places, LineKind kind, int line) {
    for (std::size_t k = 0; k < places.size(); k += std::max<std::size_t>(1, places.size() / 20)) {
      const auto& [at, across] = places[k];
      LineMark mark{at, across, 0.002 + 0.001 * dot(at, at), 0.002, kind, line};
      mark.at = at + sight.noise * mark.sigma * normal(random) * across;
      mark.eye.z = sight.eye_height;
      if (sight.eye_height > 0) mark.at = believed_level(mark.at, sight);
      seen.marks.push_back(mark);
    }
  };
  constexpr double step = 0.02;
  for (const FieldLine& line : target.curves.lines) {
    std::vector<std::pair<FloorPoint, FloorPoint>> places;
    const double length = distance(line.p, line.q);
    const FieldPoint along = (1 / length) * (line.q - line.p);
    const FloorPoint p0 = robot_from_field * line.p,
                     across = robot_from_field * (line.p + FieldPoint{-along.y, along.x}) - p0;
    for (double s = 0; s <= length; s += step) {
      const FloorPoint p = robot_from_field * (line.p + s * along);
      if (visible(p)) places.emplace_back(p, across);
    }
    if (places.size() >= 20) add(places, line.is_wall ? LineKind::boundary : LineKind::line, number++);
  }
  for (const FieldArc& arc : target.curves.arcs) {
    std::vector<std::pair<FloorPoint, FloorPoint>> places;
    const FloorPoint center = robot_from_field * arc.center;
    for (double a = arc.from; a < arc.to; a += step) {
      const FloorPoint p = robot_from_field * (arc.center + arc.radius * FieldPoint{std::cos(a), std::sin(a)});
      if (visible(p)) places.emplace_back(p, (1 / arc.radius) * (p - center));
    }
    if (places.size() >= 50) add(places, LineKind::line, LineMark::kCircle);
  }
  for (const FieldModel::Goal& goal : target.field.goals) {
    if (!sight.goals) break;
    const bool plus = goal.side == GoalSide::plus_x;
    const double x = (plus ? 1 : -1) * target.field.length / 2, half = goal.width / 2;
    const FloorPoint left = robot_from_field * FieldPoint{x, plus ? half : -half},
                     right = robot_from_field * FieldPoint{x, plus ? -half : half};
    if (!visible(left) || !visible(right)) continue;
    Goal one;
    one.color = goal.color;
    one.position = 0.5 * (left + right);
    one.bearing = bearing(*one.position);
    one.posts.push_back({PostSide::left, left});
    one.posts.push_back({PostSide::right, right});
    seen.goals.push_back(one);
  }
  return seen;
}

inline double place_error(const PoseGaussian& pose, const FieldFromRobot& truth) {
  return std::hypot(pose.x - truth.x, pose.y - truth.y);
}
inline double turn_error(const PoseGaussian& pose, const FieldFromRobot& truth) {
  return std::abs(wrap_angle(pose.theta - truth.theta()));
}

}  // namespace tassilo::test
