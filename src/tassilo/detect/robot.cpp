#include "tassilo/detect/robot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/base/median.h"
#include "tassilo/base/sort_stably.h"
#include "tassilo/detect/edge.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

/// What stands below the lowest pixel of a stretch.
enum class Under { floor, ball, border, other };

/// Robot colors in one column, from its foot up.
struct Stretch {
  int column = 0;
  int top = 0, foot = 0;  ///< Rows, both inside.
  Under under = Under::other;
  std::array<int, 2> marker{};  ///< Pixels of cyan, of magenta.
  int black = 0;
  double foot_row = 0;  ///< Sub-pixel lower rim. [px]
  std::optional<FloorPoint> foot_on_floor;

  /// Its marker color: the larger one, when there is enough of it.
  Team team() const {
    const int most = std::max(marker[0], marker[1]);
    if (most < 2) return Team::unknown;
    return marker[0] >= marker[1] ? Team::cyan : Team::magenta;
  }
  double range() const { return foot_on_floor ? norm(*foot_on_floor) : 0; }
};

/// How many rows a field line lying below a pixel may cover.
int line_rows(const View& view, int column, int row) {
  constexpr double slant = 1.5;  // crossed at 45 degrees
  if (view.optics == nullptr) return view.segmentation.height / 60;
  if (!view.inside(column, row + 1)) return 0;
  const auto here = view.optics->ground.at(column, row), below = view.optics->ground.at(column, row + 1);
  if (!here || !below) return 0;
  return static_cast<int>(slant * view.field.line_width / std::max(1e-4, distance(*here, *below)));
}

Under look_under(const View& view, int column, int foot, const RobotOptions& options) {
  // A line that touches the robot has no carpet on this side, so the surface cannot know it from a wall.
  const int reach = 1 + options.gap_px + line_rows(view, column, foot);
  for (int r = foot + 1; r <= foot + reach; ++r) {
    if (!view.inside(column, r)) return Under::border;
    if (view.surface.is_floor(column, r)) return Under::floor;
    if (to_string(view.color(column, r)) == view.field.ball.color) return Under::ball;
  }
  return Under::other;
}

void place_foot(const View& view, Stretch& stretch) {
  stretch.foot_row = stretch.foot + 0.5;
  if (stretch.under == Under::floor) {
    const PixelPoint rim{static_cast<double>(stretch.column), stretch.foot_row};
    if (const auto edge = find_edge(view.frame, {.at = rim, .outward = {0, 1}, .reach_px = 2.5}))
      stretch.foot_row = edge->y;
  }
  if (view.optics != nullptr)
    stretch.foot_on_floor = view.optics->camera.floor_point({static_cast<double>(stretch.column), stretch.foot_row}, 0,
                                                            2 * longest_distance(view.field));
}

/// All stretches of one column that are high enough, from the bottom up.
void stretches_of(const View& view, int column, const RobotOptions& options, RecycledVector<Stretch>& out) {
  int r = view.segmentation.height - 1;
  while (r >= 0) {
    if (!is_robot_color(view.color(column, r))) {
      --r;
      continue;
    }
    Stretch stretch;
    stretch.column = column;
    stretch.foot = r;
    int gap = 0;
    for (; r >= 0 && gap <= options.gap_px; --r) {
      const ColorClass color = view.color(column, r);
      if (!is_robot_color(color)) {
        // Carpet ends a robot, an unknown rim between two of its colors does not.
        if (color != ColorClass::no_color) break;
        ++gap;
        continue;
      }
      gap = 0;
      stretch.top = r;
      stretch.black += color == ColorClass::black;
      stretch.marker[0] += color == ColorClass::cyan;
      stretch.marker[1] += color == ColorClass::magenta;
    }
    if (stretch.foot - stretch.top + 1 < options.min_rows) continue;
    stretch.under = look_under(view, column, stretch.foot, options);
    if (stretch.under == Under::other) continue;
    place_foot(view, stretch);
    if (view.optics != nullptr && stretch.under != Under::border &&
        (!stretch.foot_on_floor || stretch.range() > longest_distance(view.field)))
      continue;
    out.push_back(stretch);
  }
}

bool belong_together(const View& view, const Stretch& a, const Stretch& b, const RobotOptions& options) {
  if (std::max(a.top, b.top) > std::min(a.foot, b.foot)) return false;
  if (a.team() != Team::unknown && b.team() != Team::unknown && a.team() != b.team()) return false;
  // A foot behind the ball or below the image tells nothing of the distance.
  if (a.under != Under::floor || b.under != Under::floor) return true;
  if (std::abs(a.foot_row - b.foot_row) <= 2.0) return true;
  if (view.optics == nullptr) return std::abs(a.foot_row - b.foot_row) <= 0.02 * view.segmentation.height + 2;
  return std::abs(a.range() - b.range()) <= options.max_step;
}

/// Outline point nearest to us, from feet smoothed over neighboring columns; nothing when no foot is seen.
std::optional<PixelPoint> nearest_foot(const View& view, const RecycledVector<Stretch>& parts) {
  RecycledVector<PixelPoint> feet;
  for (const Stretch& part : parts)
    if (part.under == Under::floor) feet.push_back({static_cast<double>(part.column), part.foot_row});
  if (feet.empty()) return std::nullopt;
  // Columns at either end are half robot, half background.
  const std::size_t skip = feet.size() >= 8 ? 1 : 0;
  std::optional<PixelPoint> best;
  double best_range = 0;
  for (std::size_t i = skip; i + skip < feet.size(); ++i) {
    const std::size_t from = i >= 2 ? i - 2 : 0, to = std::min(feet.size(), i + 3);
    RecycledVector<double> rows;
    for (std::size_t k = from; k < to; ++k) rows.push_back(feet[k].y);
    const PixelPoint smooth{feet[i].x, median(std::move(rows))};
    const auto point = view.optics->camera.floor_point(smooth);
    if (point && (!best || norm(*point) < best_range)) {
      best = smooth;
      best_range = norm(*point);
    }
  }
  return best;
}

std::optional<RobotOnFloor> on_floor(const View& view, const RecycledVector<Stretch>& parts,
                                     const RobotOptions& options) {
  const MountedCamera& camera = view.optics->camera;
  auto foot = nearest_foot(view, parts);
  const bool cut = !foot;
  if (cut) {
    // The foot lies below the image or behind the ball: the lowest visible point bounds the distance from above.
    const auto& lowest = *std::ranges::max_element(parts, {}, &Stretch::foot);
    foot = PixelPoint{static_cast<double>(lowest.column), lowest.foot + 0.5};
  }
  const auto seen = floor_gaussian(camera, *foot, options.foot_sigma_px, view.optics->mount_sigma);
  if (!seen) return std::nullopt;
  RobotOnFloor robot;
  robot.nearest = *seen;
  const double range = norm(seen->mean);
  const double reach = options.bound_sigmas * options.foot_sigma_px;
  const auto nearer = camera.floor_point(*foot + PixelPoint{0, reach});
  const auto further = camera.floor_point(*foot - PixelPoint{0, reach});
  // Where the lens shows no place nearer, or the horizon is near, there is no such bound.
  robot.bounds.near = !cut && nearer ? std::min(range, norm(*nearer)) : 0;
  robot.bounds.far = further ? std::max(range, norm(*further)) : std::numeric_limits<double>::infinity();

  const double eye_range = distance(seen->mean, foot_of(camera));
  const auto left = camera.ray({parts.front().column - 0.5, foot->y});
  const auto right = camera.ray({parts.back().column + 0.5, foot->y});
  if (left && right) {
    const double angle = std::abs(wrap_angle(std::atan2(left->y, left->x) - std::atan2(right->y, right->x)));
    robot.width = 2 * eye_range * std::tan(angle / 2);
  }
  // The middle lies half a width behind the nearest point, along the sight of the robot's middle.
  const double depth = std::clamp(robot.width, view.field.robots.width.low, view.field.robots.width.high) / 2;
  const PixelPoint middle{(parts.front().column + parts.back().column) / 2.0, foot->y};
  robot.center = floor_at_range(camera, middle, eye_range + depth).value_or(seen->mean);
  return robot;
}

std::optional<RobotSeen> robot_of(const View& view, const RecycledVector<Stretch>& parts, const RobotOptions& options) {
  if (static_cast<int>(parts.size()) < options.min_columns) return std::nullopt;
  std::array<int, 2> marker{};
  int black = 0, border = 0;
  RobotSeen robot;
  robot.box = {parts.front().column, parts.front().top, parts.back().column + 1, parts.front().foot + 1};
  for (const Stretch& part : parts) {
    marker[0] += part.marker[0];
    marker[1] += part.marker[1];
    black += part.black;
    border += part.under == Under::border;
    robot.box.y0 = std::min(robot.box.y0, part.top);
    robot.box.y1 = std::max(robot.box.y1, part.foot + 1);
  }
  const int colored = marker[0] + marker[1];
  if (colored * 20 >= black && colored >= 4) robot.team = marker[0] >= marker[1] ? Team::cyan : Team::magenta;
  const bool cut_above = robot.box.y0 == 0;
  const bool cut_aside = robot.box.x0 == 0 || robot.box.x1 == view.segmentation.width;
  // A body alone may be a shadow or a board: its size on the floor could tell, but not from a wall of the same color.
  const bool like_wall = view.field.walls && view.field.walls->color == view.field.robots.body;
  if (robot.team == Team::unknown && (view.optics == nullptr || like_wall)) return std::nullopt;
  if (black < 3 && border == 0) return std::nullopt;
  if (view.optics == nullptr) return robot;

  robot.floor = on_floor(view, parts, options);
  if (!robot.floor) return std::nullopt;
  const MountedCamera& camera = view.optics->camera;
  const double eye_range = distance(robot.floor->nearest.mean, foot_of(camera));
  const auto height = height_at_range(camera, {(robot.box.x0 + robot.box.x1) / 2.0, robot.box.y0 - 0.5}, eye_range);
  // Half of the least height allows for a far top that blends with what is behind it.
  if (!cut_above && height && *height < 0.5 * view.field.robots.height.low) return std::nullopt;
  if (robot.floor->width > 2.5 * view.field.robots.width.high) return std::nullopt;
  if (robot.team == Team::unknown && robot.floor->width > 1.3 * view.field.robots.width.high) return std::nullopt;
  if (robot.team == Team::unknown && robot.floor->width < 0.5 * view.field.robots.width.low && !cut_aside)
    return std::nullopt;
  return robot;
}

/// Is `rim` but the side of `robot`? Lenses and tapered bodies make sides slant: over a few columns the foot seems to
/// climb.
bool is_rim_of(const View& view, const RobotSeen& rim, const RobotSeen& robot, const RobotOptions& options) {
  if (rim.team != robot.team && rim.team != Team::unknown) return false;
  const bool beside = rim.box.x0 <= robot.box.x1 + options.gap_px && robot.box.x0 <= rim.box.x1 + options.gap_px;
  const bool level = rim.box.y0 < robot.box.y1 && robot.box.y0 < rim.box.y1;
  if (!beside || !level || rim.box.width() >= robot.box.width()) return false;
  if (!rim.floor || !robot.floor) return rim.box.width() * 4 < robot.box.width();
  return rim.floor->width < 0.4 * view.field.robots.width.low && rim.floor->width < 0.4 * robot.floor->width;
}

/// Rims join the robot they belong to.
RecycledVector<RobotSeen> without_rims(const View& view, RecycledVector<RobotSeen> robots,
                                       const RobotOptions& options) {
  RecycledVector<bool> gone(robots.size(), false);
  for (std::size_t i = 0; i < robots.size(); ++i)
    for (std::size_t k = 0; k < robots.size() && !gone[i]; ++k)
      if (k != i && !gone[k] && is_rim_of(view, robots[i], robots[k], options)) {
        robots[k].box = hull(robots[k].box, robots[i].box);
        gone[i] = true;
      }
  RecycledVector<RobotSeen> kept;
  for (std::size_t i = 0; i < robots.size(); ++i)
    if (!gone[i]) kept.push_back(std::move(robots[i]));
  return kept;
}

}  // namespace

void RobotOptions::check() const {
  const auto least = [](const char* name, double value, double low, bool open) {
    if (open ? !(value > low) : !(value >= low))
      throw Error(std::string("robot.") + name,
                  "is " + std::to_string(value) + ", must be " + (open ? "> " : ">= ") + std::to_string(low));
  };
  least("min_columns", min_columns, 1, false);
  least("min_rows", min_rows, 1, false);
  least("gap_px", gap_px, 0, false);
  least("max_step", max_step, 0, true);
  least("foot_sigma_px", foot_sigma_px, 0, true);
  least("bound_sigmas", bound_sigmas, 0, true);
}

RecycledVector<RobotSeen> find_robots(const View& view, const RobotOptions& options) {
  RecycledVector<RecycledVector<Stretch>> chains;
  RecycledVector<std::size_t> open;  // chains that may still grow
  RecycledVector<Stretch> column;
  for (int c = 0; c < view.segmentation.width; ++c) {
    column.clear();
    stretches_of(view, c, options, column);
    std::erase_if(open, [&](std::size_t k) { return chains[k].back().column < c - 1 - options.gap_px; });
    for (const Stretch& stretch : column) {
      // The chain whose foot is nearest, not yet continued in this column.
      std::optional<std::size_t> best;
      for (const std::size_t k : open) {
        const Stretch& last = chains[k].back();
        if (last.column == c || !belong_together(view, last, stretch, options)) continue;
        if (!best ||
            std::abs(last.foot_row - stretch.foot_row) < std::abs(chains[*best].back().foot_row - stretch.foot_row))
          best = k;
      }
      if (best) {
        chains[*best].push_back(stretch);
      } else {
        open.push_back(chains.size());
        chains.push_back({stretch});
      }
    }
  }
  RecycledVector<RobotSeen> robots;
  for (const auto& chain : chains)
    if (auto robot = robot_of(view, chain, options)) robots.push_back(std::move(*robot));
  robots = without_rims(view, std::move(robots), options);
  // Chains begin from left to right; a robot that took over a rim may begin further left.
  sort_stably(robots, {}, [](const RobotSeen& robot) { return robot.box.x0; });
  return robots;
}

}  // namespace tassilo
