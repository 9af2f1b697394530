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

/// A segment as a line of the robot's floor: through `middle`, the normal away from the robot.
struct FloorLine {
  FloorPoint middle;
  double normal = 0;  ///< [rad]
  double length = 0;  ///< [m]
  /// Of the direction, and of the middle across the line; taken as independent of each other.
  double sigma_normal = 0, sigma_middle = 0;
  double column = 0;  ///< Of its middle in the image. [px]

  double distance() const { return dot(middle, {std::cos(normal), std::sin(normal)}); }  ///< Of the robot. [m]
};

FloorLine floor_line(const BoundarySegment& segment, const MountedCamera& camera) {
  FloorLine line;
  const FloorPoint along = segment.q - segment.p;
  line.length = norm(along);
  line.middle = 0.5 * (segment.p + segment.q);
  FloorPoint n{-along.y / line.length, along.x / line.length};
  if (dot(n, segment.p) < 0) n = -1.0 * n;
  line.normal = bearing(n);
  line.column = 0.5 * (segment.image_p.x + segment.image_q.x);
  // How far an end moves across the line with a pixel's error there.
  const auto sigma_at = [&](PixelPoint pixel, FloorPoint at) {
    const auto below = camera.floor_point({pixel.x, pixel.y + 1});
    const double per_px = below ? distance(*below, at) : 0.1 * norm(at);
    return std::max(segment.sigma_px * per_px, 1e-3);
  };
  const double sigma = std::hypot(sigma_at(segment.image_p, segment.p), sigma_at(segment.image_q, segment.q));
  line.sigma_normal = sigma / line.length;
  line.sigma_middle = sigma / 2;
  return line;
}

double off_orthogonal(double normal_a, double normal_b) {
  const double turn = wrap_angle(normal_b - normal_a);
  return turn > 0 ? turn - kPi / 2 : turn + kPi / 2;
}

/// How far from a goal's color its end line may begin: a white post stands between, and both rims are blurred. [px]
double goal_reach(const Region& goal, const MountedCamera& camera) {
  constexpr double blurred = 6, most = 60;  // [px]
  constexpr double post = 0.15;             // [m]
  const PixelBox box = bounding_box(goal);
  const auto foot = camera.floor_point({0.5 * (box.x0 + box.x1 - 1), box.y1 - 1.0});
  if (!foot) return blurred;
  return std::min(blurred + post * camera.model().fx / std::max(norm(*foot), 0.1), most);
}

/// Does a segment, or its continuation by a piece that may be hidden or too short to be a line, come near a goal?
bool touches(const BoundarySegment& segment, const Region& dilated_goal, const MountedCamera& camera) {
  constexpr int steps = 64;
  constexpr double hidden = 0.5;  // [m] a robot's width
  const FloorPoint way = segment.q - segment.p, more = (hidden / norm(way)) * way;
  const FloorPoint from = segment.p - more, to = segment.q + more;
  for (int k = 0; k <= steps; ++k) {
    const FloorPoint at = from + static_cast<double>(k) / steps * (to - from);
    const auto pixel = camera.project({at.x, at.y, 0});
    if (pixel &&
        contains(dilated_goal, static_cast<int>(std::lround(pixel->x)), static_cast<int>(std::lround(pixel->y))))
      return true;
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

/// One number measured, as a function of the pose near which it was looked at.
struct Measurement {
  Eigen::RowVector3d by_pose;
  double off = 0;    ///< Measured less expected.
  double sigma = 0;  ///< Of the measured one.
};
/// theta = wall.normal - line.normal.
Measurement direction_of(const FloorLine& line, const Wall& wall, const PoseGaussian& pose) {
  return {{0, 0, 1}, wrap_angle(wall.normal - line.normal - pose.theta), line.sigma_normal};
}
/// The middle lies on the wall.
Measurement distance_of(const FloorLine& line, const Wall& wall, const PoseGaussian& pose) {
  const FieldPoint n{std::cos(wall.normal), std::sin(wall.normal)};
  const double c = std::cos(pose.theta), s = std::sin(pose.theta);
  const FieldPoint turned{c * line.middle.x - s * line.middle.y, s * line.middle.x + c * line.middle.y};
  return {{n.x, n.y, -n.x * turned.y + n.y * turned.x},
          wall.distance - dot(n, FieldPoint{pose.x, pose.y} + turned),
          line.sigma_middle};
}

/// Kalman update; false, and nothing changed, where the measurement is too far from what is expected.
bool update(PoseGaussian& pose, const Measurement& measured) {
  constexpr double most_sigmas = 3.3;  // one in a thousand
  const Eigen::Vector3d spread = pose.covariance * measured.by_pose.transpose();
  const double noise = measured.sigma * measured.sigma, expected = measured.by_pose.dot(spread) + noise;
  if (measured.off * measured.off > most_sigmas * most_sigmas * expected) return false;
  const Eigen::Vector3d gain = spread / expected, step = gain * measured.off;
  pose.x += step[0];
  pose.y += step[1];
  pose.theta = wrap_angle(pose.theta + step[2]);
  const Eigen::Matrix3d left = Eigen::Matrix3d::Identity() - gain * measured.by_pose;
  pose.covariance = left * pose.covariance * left.transpose() + gain * noise * gain.transpose();
  return true;
}

/// A pose of which only the orientation is known, and that roughly.
PoseGaussian hardly_known(const PoseGaussian& pose) {
  PoseGaussian unknown = pose;
  unknown.covariance = Eigen::Vector3d(100, 100, 10).asDiagonal();
  return unknown;
}

/// A line and the wall it is taken for, by their indices.
struct Pair {
  std::size_t line, wall;
};

/// A goal's end line, and a side line; empty when no line is adjacent to a goal.
RecycledVector<Pair> pairs_by_goal(const FieldTarget& target, const BoundaryObservation& seen,
                                   const RecycledVector<FloorLine>& lines) {
  RecycledVector<Pair> pairs;
  for (const GoalInImage& goal : seen.goals) {
    const FieldModel::Goal* model = goal_of(target, goal.color);
    if (model == nullptr || goal.region.empty()) continue;
    const Region near = dilation(goal.region, disc(goal_reach(goal.region, seen.camera)));
    std::optional<std::size_t> end;
    for (std::size_t k = 0; k < lines.size(); ++k)
      if (touches(seen.segments[k], near, seen.camera) && (!end || lines[k].length > lines[*end].length)) end = k;
    if (!end) continue;
    const bool plus = model->side == GoalSide::plus_x;
    pairs.push_back({*end, plus ? 0u : 2u});
    if (const auto side = across(lines, *end)) {
      const PixelBox box = bounding_box(goal.region);
      const bool left = lines[*side].column < 0.5 * (box.x0 + box.x1 - 1);
      // Looking at the +x goal, +y is to the left.
      pairs.push_back({*side, left == plus ? 1u : 3u});
    }
    return pairs;
  }
  return pairs;
}

/// The longest line and the longest across it, as the walls that turn the predicted orientation least.
RecycledVector<Pair> pairs_by_orientation(const std::array<Wall, 4>& walls, const RecycledVector<FloorLine>& lines,
                                          double theta) {
  const auto nearest_wall = [&](std::size_t k) {
    const auto nearest = std::ranges::min_element(
        walls, {}, [&](const Wall& wall) { return std::abs(wrap_angle(wall.normal - lines[k].normal - theta)); });
    return static_cast<std::size_t>(nearest - walls.begin());
  };
  const auto longest =
      static_cast<std::size_t>(std::ranges::max_element(lines, {}, &FloorLine::length) - lines.begin());
  RecycledVector<Pair> pairs{{longest, nearest_wall(longest)}};
  if (const auto other = across(lines, longest)) pairs.push_back({*other, nearest_wall(*other)});
  return pairs;
}

/// Parallel walls cannot both be meant, and a line of the other handedness is none of the field's.
bool turn_alike(const FloorLine& a, const FloorLine& b, const Wall& of_a, const Wall& of_b) {
  return std::abs(wrap_angle(b.normal - a.normal - (of_b.normal - of_a.normal))) <= kPi / 4;
}

/// Turns two lines to the closest orthogonal pair: the one whose direction is known less turns more.
void orthogonalize(FloorLine& a, FloorLine& b) {
  const double off = off_orthogonal(a.normal, b.normal);
  const double of_a = a.sigma_normal * a.sigma_normal, of_b = b.sigma_normal * b.sigma_normal;
  a.normal += off * of_a / (of_a + of_b);
  b.normal -= off * of_b / (of_a + of_b);
}

}  // namespace

BoundaryFix pose_by_boundary(const FieldTarget& target, const BoundaryObservation& seen,
                             const std::optional<PoseGaussian>& predicted) {
  BoundaryFix fix;
  fix.pose = predicted;
  const auto why = [&](std::string_view reason) { fix.why.append(fix.why.empty() ? "" : ", ").append(reason); };
  RecycledVector<FloorLine> lines;
  for (const BoundarySegment& segment : seen.segments) lines.push_back(floor_line(segment, seen.camera));
  if (lines.empty()) {
    why("no line of the boundary");
    return fix;
  }
  const std::array<Wall, 4> walls = walls_of(target.extent);

  RecycledVector<Pair> pairs = pairs_by_goal(target, seen, lines);
  if (pairs.empty() && predicted) pairs = pairs_by_orientation(walls, lines, predicted->theta);
  if (pairs.empty()) {
    why("lines, but neither a goal nor an orientation to tell them apart");
    return fix;
  }
  if (pairs.size() == 2) {
    FloorLine &a = lines[pairs[0].line], &b = lines[pairs[1].line];
    if (turn_alike(a, b, walls[pairs[0].wall], walls[pairs[1].wall])) {
      orthogonalize(a, b);
    } else {
      pairs.pop_back();
      why("the second line turns the wrong way");
    }
  }
  if (!predicted && pairs.size() < 2) {
    why("one line does not tell where along it");
    return fix;
  }

  // With nothing known before, the lines alone: a prediction that says nothing.
  PoseGaussian pose = predicted
                          ? *predicted
                          : hardly_known({0, 0, wrap_angle(walls[pairs[0].wall].normal - lines[pairs[0].line].normal)});
  for (const auto& [line, wall] : pairs) {
    constexpr double margin = 0.3;  // [m]
    // The direction first: how far off the middle is depends on it.
    PoseGaussian updated = pose;
    if (lines[line].distance() > walls[wall].distance + walls[(wall + 2) % 4].distance + margin) {
      why(walls[wall].name);
      fix.why.append(" would be farther than the field is wide");
    } else if (!update(updated, direction_of(lines[line], walls[wall], updated)) ||
               !update(updated, distance_of(lines[line], walls[wall], updated))) {
      ++fix.refused;
      why(walls[wall].name);
      fix.why.append(" is not where it was expected");
    } else {
      pose = updated;
      fix.matches.push_back({line, walls[wall].name});
      why(walls[wall].name);
    }
  }
  if (fix.matches.size() < (predicted ? 1u : 2u)) {
    fix.matches.clear();
    return fix;
  }
  fix.pose = pose;
  fix.kind = fix.matches.size() == 2 ? PoseKind::two_lines : PoseKind::one_line;
  return fix;
}

Localized localize_by_boundary(const FieldTarget& target, const PoseBelief& before, const RobotMotion& motion,
                               const BoundaryObservation& seen, double t) {
  constexpr int enough_doubts = 3;
  constexpr double certain = 0.95;
  Localized result;
  std::optional<PoseGaussian> predicted;
  if (before.told && share_of_best(before) >= certain) predicted = moved(before.hypotheses.front().pose, motion);
  const bool doubtful = before.doubts >= enough_doubts;
  BoundaryFix fix =
      pose_by_boundary(target, seen, predicted && doubtful ? std::optional(hardly_known(*predicted)) : predicted);
  if (fix.matches.empty()) fix.pose = predicted;

  PoseBelief& belief = result.belief;
  belief.t = t;
  belief.fixed_at = fix.matches.empty() ? before.fixed_at : t;
  belief.tied = before.tied || !fix.matches.empty();
  belief.doubts = fix.refused > 0 ? before.doubts + 1 : fix.matches.empty() ? before.doubts : 0;
  result.why = std::move(fix.why);
  if (!fix.pose) {
    for (const PoseHypothesis& one : before.hypotheses)
      belief.hypotheses.push_back({moved(one.pose, motion), one.log_weight});
    return result;
  }
  belief.told = true;
  belief.hypotheses.push_back({*fix.pose, 0});
  result.pose = told_pose(*fix.pose, fix.kind, t - belief.fixed_at);
  return result;
}

}  // namespace tassilo
