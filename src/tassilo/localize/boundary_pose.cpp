#include "tassilo/localize/boundary_pose.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tassilo/geometry/angle.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

constexpr double kPi = std::numbers::pi;

/// A wall: x cos(normal) + y sin(normal) = distance.
struct Wall {
  std::string_view name;
  double normal = 0;    ///< Outwards. [rad]
  double distance = 0;  ///< From the field's centre. [m]
};
/// Counter-clockwise: the one opposite to k is k + 2, modulo 4.
std::array<Wall, 4> walls_of(const FieldExtent& extent) {
  const auto& [x, y] = extent;
  return {
      {{"x_plus", 0, x.high}, {"y_plus", kPi / 2, y.high}, {"x_minus", kPi, -x.low}, {"y_minus", -kPi / 2, -y.low}}};
}

/// A segment as a line of the robot's floor: x cos(normal) + y sin(normal) = distance, the normal away from the robot.
struct FloorLine {
  double normal = 0, distance = 0;  ///< [rad, m]
  double length = 0;                ///< [m]
  double sigma_normal = 0, sigma_distance = 0;
  double column = 0;  ///< Of its middle in the image. [px]
};

FloorLine floor_line(const BoundarySegment& segment, const MountedCamera& camera) {
  FloorLine line;
  const FloorPoint along = segment.q - segment.p;
  line.length = norm(along);
  FloorPoint n{-along.y / line.length, along.x / line.length};
  if (dot(n, segment.p) < 0) n = -1.0 * n;
  line.normal = bearing(n);
  line.distance = dot(n, segment.p);
  line.column = 0.5 * (segment.image_p.x + segment.image_q.x);
  // How far an end moves across the line with a pixel's error there.
  const double residual = std::hypot(segment.residual_px, 1.0);
  const auto sigma_at = [&](PixelPoint pixel, FloorPoint at) {
    const auto below = camera.floor_point({pixel.x, pixel.y + 1});
    const double per_px = below ? distance(*below, at) : 0.1 * norm(at);
    return std::max(residual * per_px, 1e-3);
  };
  const double sp = sigma_at(segment.image_p, segment.p), sq = sigma_at(segment.image_q, segment.q);
  line.sigma_normal = std::hypot(sp, sq) / line.length;
  // At the foot of the perpendicular, which may lie beyond the ends.
  const double t = -dot(segment.p, along) / (line.length * line.length);
  line.sigma_distance = std::hypot((1 - t) * sp, t * sq);
  return line;
}

double off_orthogonal(double normal_a, double normal_b) {
  const double turn = wrap_angle(normal_b - normal_a);
  return turn > 0 ? turn - kPi / 2 : turn + kPi / 2;
}

bool touches(const BoundarySegment& segment, const Region& dilated_goal) {
  constexpr int steps = 64;
  for (int k = 0; k <= steps; ++k) {
    const PixelPoint p = segment.image_p + (static_cast<double>(k) / steps) * (segment.image_q - segment.image_p);
    if (contains(dilated_goal, static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y)))) return true;
  }
  return false;
}

/// The longest segment across `first`, if any.
std::optional<std::size_t> across(const RecycledVector<FloorLine>& lines, std::size_t first) {
  constexpr double tolerance = radians(20);
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < lines.size(); ++k)
    if (k != first && std::abs(off_orthogonal(lines[first].normal, lines[k].normal)) <= tolerance &&
        (!best || lines[k].length > lines[*best].length))
      best = k;
  return best;
}

/// Kalman update by one line's orientation and distance.
void update(PoseGaussian& pose, const FloorLine& line, const Wall& wall) {
  const double c = std::cos(wall.normal), s = std::sin(wall.normal);
  // theta = wall.normal - line.normal; x c + y s = wall.distance - line.distance.
  Eigen::Matrix<double, 2, 3> by_pose;
  by_pose << 0, 0, 1, c, s, 0;
  const Eigen::Vector2d off(wrap_angle(wall.normal - line.normal - pose.theta),
                            wall.distance - line.distance - (c * pose.x + s * pose.y));
  const Eigen::Matrix2d noise =
      Eigen::Vector2d(line.sigma_normal * line.sigma_normal, line.sigma_distance * line.sigma_distance).asDiagonal();
  const Eigen::Matrix<double, 3, 2> gain =
      pose.covariance * by_pose.transpose() * (by_pose * pose.covariance * by_pose.transpose() + noise).inverse();
  const Eigen::Vector3d step = gain * off;
  pose.x += step[0];
  pose.y += step[1];
  pose.theta = wrap_angle(pose.theta + step[2]);
  const Eigen::Matrix3d left = Eigen::Matrix3d::Identity() - gain * by_pose;
  pose.covariance = left * pose.covariance * left.transpose() + gain * noise * gain.transpose();
}

}  // namespace

BoundaryFix pose_by_boundary(const FieldTarget& target, std::span<const BoundarySegment> segments,
                             std::span<const GoalInImage> goals, const std::optional<PoseGaussian>& predicted,
                             const MountedCamera& camera) {
  BoundaryFix fix;
  fix.pose = predicted;
  RecycledVector<FloorLine> lines;
  for (const BoundarySegment& segment : segments) lines.push_back(floor_line(segment, camera));
  const std::array<Wall, 4> walls = walls_of(target.extent);
  if (lines.empty()) {
    fix.why = "no line of the boundary";
    return fix;
  }

  struct Pair {
    std::size_t line, wall;
  };
  RecycledVector<Pair> pairs;
  // By a goal: its end line, then a side line.
  for (const GoalInImage& goal : goals) {
    const FieldModel::Goal* model = goal_of(target, goal.color);
    if (model == nullptr || goal.region.empty()) continue;
    constexpr double reach = 6;  // [px] the rims of goal and wall, both blurred
    const Region near = dilation(goal.region, disc(reach));
    std::optional<std::size_t> end;
    for (std::size_t k = 0; k < lines.size(); ++k)
      if (touches(segments[k], near) && (!end || lines[k].length > lines[*end].length)) end = k;
    if (!end) continue;
    const bool plus = model->side == GoalSide::plus_x;
    pairs.push_back({*end, plus ? 0u : 2u});
    if (const auto side = across(lines, *end)) {
      const PixelBox box = bounding_box(goal.region);
      const bool left = lines[*side].column < 0.5 * (box.x0 + box.x1 - 1);
      // Looking at the +x goal, +y is to the left.
      pairs.push_back({*side, left == plus ? 1u : 3u});
    }
    break;
  }
  // By the predicted orientation.
  if (pairs.empty()) {
    if (!predicted) {
      fix.why = "lines, but neither a goal nor an orientation to tell them apart";
      return fix;
    }
    const auto nearest_wall = [&](std::size_t k) {
      const auto nearest = std::ranges::min_element(walls, {}, [&](const Wall& wall) {
        return std::abs(wrap_angle(wall.normal - lines[k].normal - predicted->theta));
      });
      return static_cast<std::size_t>(nearest - walls.begin());
    };
    std::size_t longest = 0;
    for (std::size_t k = 1; k < lines.size(); ++k)
      if (lines[k].length > lines[longest].length) longest = k;
    pairs.push_back({longest, nearest_wall(longest)});
    if (const auto other = across(lines, longest)) pairs.push_back({*other, nearest_wall(*other)});
  }
  // Parallel walls cannot both be meant, and a line of the other handedness is none of the field's.
  if (pairs.size() == 2) {
    const double seen = wrap_angle(lines[pairs[1].line].normal - lines[pairs[0].line].normal);
    const double meant = wrap_angle(walls[pairs[1].wall].normal - walls[pairs[0].wall].normal);
    if (std::abs(wrap_angle(seen - meant)) > kPi / 4) {
      pairs.pop_back();
      fix.why = "the second line turns the wrong way; ";
    }
  }
  if (pairs.size() == 2) {
    const double off = off_orthogonal(lines[pairs[0].line].normal, lines[pairs[1].line].normal);
    lines[pairs[0].line].normal += off / 2;
    lines[pairs[1].line].normal -= off / 2;
  }

  if (!predicted && pairs.size() < 2) {
    fix.why.append("one line does not tell where along it");
    return fix;
  }
  // With nothing known before, the lines alone: a prediction that says nothing.
  PoseGaussian pose = predicted
                          ? *predicted
                          : PoseGaussian{0, 0, wrap_angle(walls[pairs[0].wall].normal - lines[pairs[0].line].normal),
                                         Eigen::Vector3d(100, 100, 10).asDiagonal()};
  // A line that lies where the field has none is refused.
  for (const auto& [line, wall] : pairs) {
    constexpr double margin = 0.3;  // [m]
    if (lines[line].distance <= walls[wall].distance + walls[(wall + 2) % 4].distance + margin) continue;
    fix.why.append(walls[wall].name).append(" would be farther than the field is wide");
    return fix;
  }
  for (const auto& [line, wall] : pairs) {
    update(pose, lines[line], walls[wall]);
    fix.matches.push_back({line, walls[wall].name});
  }
  fix.pose = pose;
  fix.kind = pairs.size() == 2 ? PoseKind::two_lines : PoseKind::one_line;
  fix.why.append(walls[pairs[0].wall].name);
  if (pairs.size() == 2) fix.why.append(" and ").append(walls[pairs[1].wall].name);
  return fix;
}

}  // namespace tassilo
