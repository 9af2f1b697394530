#include "tassilo/detect/robot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string>

#include "tassilo/base/median.h"
#include "tassilo/base/option_check.h"
#include "tassilo/base/sort_stably.h"
#include "tassilo/detect/edge.h"
#include "tassilo/detect/internal/column_runs.h"
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
  double range = 0;  ///< Of the foot on the floor; 0 where that is unknown. [m]

  /// Its marker color: the larger one, when there is enough of it.
  Team team() const {
    const int most = std::max(marker[0], marker[1]);
    if (most < 2) return Team::unknown;
    return marker[0] >= marker[1] ? Team::cyan : Team::magenta;
  }
};

/// What stays the same for all columns of a frame.
struct Sight {
  const View& view;
  const RobotOptions& options;
  std::optional<ColorClass> ball = color_class_from(view.field.ball.color);
  double furthest = longest_distance(view.field);
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

Under look_under(const Sight& sight, int column, int foot) {
  const View& view = sight.view;
  // A line that touches the robot has no carpet on this side, so the surface cannot know it from a wall.
  int reach = 1 + sight.options.gap_px;
  bool further = true;
  for (int r = foot + 1; r <= foot + reach; ++r) {
    if (!view.inside(column, r)) return Under::border;
    if (view.surface.is_floor(column, r)) return Under::floor;
    if (view.color(column, r) == sight.ball) return Under::ball;
    if (r == foot + reach && further) {
      reach += line_rows(view, column, foot);
      further = false;
    }
  }
  return Under::other;
}

void place_foot(const Sight& sight, Stretch& stretch) {
  stretch.foot_row = stretch.foot + 0.5;
  if (stretch.under == Under::floor) {
    const PixelPoint rim{static_cast<double>(stretch.column), stretch.foot_row};
    if (const auto edge = find_edge(sight.view.frame, {.at = rim, .outward = {0, 1}, .reach_px = 2.5}))
      stretch.foot_row = edge->y;
  }
  if (sight.view.optics == nullptr) return;
  const Optics& optics = *sight.view.optics;
  if (const auto ray = optics.ray({static_cast<double>(stretch.column), stretch.foot_row}))
    stretch.foot_on_floor = optics.camera.floor_along(*ray, 0, 2 * sight.furthest);
  if (stretch.foot_on_floor) stretch.range = norm(*stretch.foot_on_floor);
}

/// Do robots go on between two runs of a column? Carpet ends them, an unknown rim between two of their colors does not.
bool is_rim(const Sight& sight, const ColumnRun& upper, const ColumnRun& lower) {
  if (lower.top - upper.foot - 1 > sight.options.gap_px) return false;
  for (int r = upper.foot + 1; r < lower.top; ++r)
    if (sight.view.color(upper.column, r) != ColorClass::no_color) return false;
  return true;
}

/// All stretches of one column that are high enough, from the bottom up. `runs` of the column, from the top down.
void stretches_of(const Sight& sight, std::span<const ColumnRun> runs, RecycledVector<Stretch>& out) {
  for (std::size_t next = runs.size(); next > 0;) {
    Stretch stretch;
    stretch.column = runs[next - 1].column;
    stretch.foot = runs[next - 1].foot;
    do {
      const ColumnRun& run = runs[--next];
      const int pixels = run.foot - run.top + 1;
      stretch.top = run.top;
      if (run.color == ColorClass::cyan)
        stretch.marker[0] += pixels;
      else if (run.color == ColorClass::magenta)
        stretch.marker[1] += pixels;
      else
        stretch.black += pixels;
    } while (next > 0 && is_rim(sight, runs[next - 1], runs[next]));
    if (stretch.foot - stretch.top + 1 < sight.options.min_rows) continue;
    stretch.under = look_under(sight, stretch.column, stretch.foot);
    if (stretch.under == Under::other) continue;
    place_foot(sight, stretch);
    if (sight.view.optics != nullptr && stretch.under != Under::border &&
        (!stretch.foot_on_floor || stretch.range > sight.furthest))
      continue;
    out.push_back(stretch);
  }
}

/// The robots' colors along all columns, from left to right and in each column from the top down.
struct Columns {
  RecycledVector<ColumnRun> runs;
  RecycledVector<std::size_t> first;  ///< Of each column, and one more.

  std::span<const ColumnRun> of(int column) const {
    const auto c = static_cast<std::size_t>(column);
    return std::span(runs).subspan(first[c], first[c + 1] - first[c]);
  }
};

Columns columns_of(const View& view) {
  RecycledVector<ColumnRun> found;
  for (const ColorClass color : kColorClasses)
    if (view.is_robot(color)) add_column_runs(view.segmentation.of(color), color, view.segmentation.width, found);
  Columns columns;
  columns.first.resize(static_cast<std::size_t>(view.segmentation.width) + 1);
  for (const ColumnRun& run : found) ++columns.first[static_cast<std::size_t>(run.column) + 1];
  std::partial_sum(columns.first.begin(), columns.first.end(), columns.first.begin());
  columns.runs.resize(found.size());
  RecycledVector<std::size_t> next(columns.first);
  for (const ColumnRun& run : found) columns.runs[next[static_cast<std::size_t>(run.column)]++] = run;
  for (int c = 0; c < view.segmentation.width; ++c) {
    const auto from = columns.runs.begin() + static_cast<std::ptrdiff_t>(columns.first[static_cast<std::size_t>(c)]);
    const auto to = columns.runs.begin() + static_cast<std::ptrdiff_t>(columns.first[static_cast<std::size_t>(c) + 1]);
    std::ranges::sort(from, to, {}, &ColumnRun::foot);
  }
  return columns;
}

bool belong_together(const View& view, const Stretch& a, const Stretch& b, const RobotOptions& options) {
  if (std::max(a.top, b.top) > std::min(a.foot, b.foot)) return false;
  if (a.team() != Team::unknown && b.team() != Team::unknown && a.team() != b.team()) return false;
  // A foot behind the ball or below the image tells nothing of the distance.
  if (a.under != Under::floor || b.under != Under::floor) return true;
  if (std::abs(a.foot_row - b.foot_row) <= 2.0) return true;
  if (view.optics == nullptr) return std::abs(a.foot_row - b.foot_row) <= 0.02 * view.segmentation.height + 2;
  return std::abs(a.range - b.range) <= options.max_step;
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
    const auto ray = view.optics->ray(smooth);
    const auto point = ray ? view.optics->camera.floor_along(*ray) : std::nullopt;
    const double range = point ? norm(*point) : 0;
    if (point && (!best || range < best_range)) {
      best = smooth;
      best_range = range;
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
  check_at_least("robot.min_columns", min_columns, 1);
  check_at_least("robot.min_rows", min_rows, 1);
  check_at_least("robot.gap_px", gap_px, 0);
  check_above("robot.max_step", max_step, 0);
  check_above("robot.foot_sigma_px", foot_sigma_px, 0);
  check_above("robot.bound_sigmas", bound_sigmas, 0);
}

RecycledVector<RobotSeen> find_robots(const View& view, const RobotOptions& options) {
  RecycledVector<RecycledVector<Stretch>> chains;
  RecycledVector<std::size_t> open;  // chains that may still grow
  RecycledVector<Stretch> column;
  const Sight sight{view, options};
  const Columns columns = columns_of(view);
  for (int c = 0; c < view.segmentation.width; ++c) {
    column.clear();
    stretches_of(sight, columns.of(c), column);
    if (column.empty()) continue;
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
