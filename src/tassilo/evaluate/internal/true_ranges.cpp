#include "tassilo/evaluate/internal/true_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tassilo/geometry/pose2.h"

namespace tassilo {

FloorPoint nearest_outline_point(const TrueRobot& robot) {
  const FloorPoint center{robot.in_robot.x, robot.in_robot.y};
  if (!robot.is_box) {
    const double away = norm(center);
    return away > 0 ? std::max(0., 1 - robot.size[0] / 2 / away) * center : center;
  }
  const auto robot_from_box = make_pose2<RobotFrame, FieldFrame>(center.x, center.y, robot.in_robot.theta);
  const FieldPoint us = inverse(robot_from_box) * FloorPoint{0, 0};
  const double half_x = robot.size[0] / 2, half_y = robot.size[1] / 2;
  return robot_from_box * FieldPoint{std::clamp(us.x, -half_x, half_x), std::clamp(us.y, -half_y, half_y)};
}

TrueObstacles::TrueObstacles(const TrueField& field, const TrueFrame& frame) : robot_(frame.robot) {
  const double length = field.length / 2, width = field.width / 2, goal = field.goal_width / 2;
  for (const double side : {-1., 1.}) {
    const double mouth = side * length, back = side * (length + field.goal_depth);
    walls_.push_back({{mouth, -goal}, {back, -goal}});
    walls_.push_back({{mouth, goal}, {back, goal}});
    walls_.push_back({{back, -goal}, {back, goal}});
    if (!field.walls) continue;
    walls_.push_back({{mouth, goal}, {mouth, width}});
    walls_.push_back({{mouth, -goal}, {mouth, -width}});
    walls_.push_back({{-length, side * width}, {length, side * width}});
  }
  for (const TrueRobot& robot : frame.robots) {
    const FieldPoint center{robot.in_field.x, robot.in_field.y};
    if (!robot.is_box) {
      pillars_.push_back({center, robot.size[0] / 2});
      continue;
    }
    const auto field_from_box = make_pose2<FieldFrame, RobotFrame>(center.x, center.y, robot.in_field.theta);
    const double half_x = robot.size[0] / 2, half_y = robot.size[1] / 2;
    const FieldPoint corners[] = {
        field_from_box * FloorPoint{half_x, half_y}, field_from_box * FloorPoint{-half_x, half_y},
        field_from_box * FloorPoint{-half_x, -half_y}, field_from_box * FloorPoint{half_x, -half_y}};
    for (int k = 0; k < 4; ++k) walls_.push_back({corners[k], corners[(k + 3) % 4]});
  }
}

double TrueObstacles::range(FloorPoint origin, double angle) const {
  const FieldPoint start = make_pose2<FieldFrame, RobotFrame>(robot_.x, robot_.y, robot_.theta) * origin;
  const FieldPoint ray{std::cos(angle + robot_.theta), std::sin(angle + robot_.theta)};
  double nearest = std::numeric_limits<double>::infinity();
  for (const Pillar& pillar : pillars_) {
    const FieldPoint to_center = pillar.center - start;
    const double along = dot(ray, to_center);
    const double half_chord_squared = pillar.radius * pillar.radius - (dot(to_center, to_center) - along * along);
    if (half_chord_squared >= 0 && along > 0)
      nearest = std::min(nearest, std::max(0., along - std::sqrt(half_chord_squared)));
  }
  for (const Wall& wall : walls_) {
    constexpr double slack = 1e-9;  // of the wall's length, so that no ray slips through a corner
    const FieldPoint to_wall = wall.from - start, edge = wall.to - wall.from;
    const double turn = cross(ray, edge);
    if (std::abs(turn) <= 1e-12) continue;
    const double away = cross(to_wall, edge) / turn, part = cross(to_wall, ray) / turn;
    if (away > 0 && part >= -slack && part <= 1 + slack) nearest = std::min(nearest, away);
  }
  return nearest;
}

}  // namespace tassilo
