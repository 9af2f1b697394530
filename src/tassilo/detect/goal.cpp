#include "tassilo/detect/goal.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/base/median.h"
#include "tassilo/base/sort_stably.h"
#include "tassilo/detect/edge.h"
#include "tassilo/detect/internal/refusal.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/morphology.h"

namespace tassilo {
namespace {

using std::numbers::pi;
using namespace std::string_view_literals;

/// One piece of a goal's panel.
struct Piece {
  Region region;
  PixelBox box;
  int columns = 0;                 ///< With a foot in the image.
  int on_floor = 0;                ///< Of these, carpet or line below.
  int hidden = 0;                  ///< Of these, a robot or the ball below.
  std::optional<FloorPoint> foot;  ///< Middle of the feet on the floor.
};

/// Lowest row of the piece in every column of its box; -1 where the column is empty.
RecycledVector<int> lowest_rows(const Piece& piece) {
  RecycledVector<int> rows(static_cast<std::size_t>(piece.box.width()), -1);
  for (const PixelRun& run : piece.region.runs())
    for (int c = run.begin; c < run.end; ++c) rows[static_cast<std::size_t>(c - piece.box.x0)] = run.row;
  return rows;
}

/// What lies below the lowest pixel of a column of the panel.
enum class Below { floor, hidden, other };

Below look_below(const View& view, int column, int row) {
  constexpr int rim_px = 3;  // of mixed colors
  for (int r = row + 1; r <= row + rim_px && view.inside(column, r); ++r)
    if (view.surface.is_floor(column, r)) return Below::floor;
  // Robots have gray parts above their colored ones: up to a twentieth of the image may lie between.
  for (int r = row + 1; r <= row + rim_px + view.segmentation.height / 20 && view.inside(column, r); ++r) {
    const ColorClass color = view.color(column, r);
    if (view.is_robot(color) || to_string(color) == view.field.ball.color) return Below::hidden;
    if (color != ColorClass::no_color) break;
  }
  return Below::other;
}

Piece piece_of(const View& view, Region region) {
  Piece piece;
  piece.box = bounding_box(region);
  piece.region = std::move(region);
  const auto rows = lowest_rows(piece);
  RecycledVector<FloorPoint> feet;
  for (int c = piece.box.x0; c < piece.box.x1; ++c) {
    const int row = rows[static_cast<std::size_t>(c - piece.box.x0)];
    if (row < 0 || !view.inside(c, row + 1)) continue;
    ++piece.columns;
    const Below below = look_below(view, c, row);
    piece.hidden += below == Below::hidden;
    if (below != Below::floor) continue;
    ++piece.on_floor;
    if (view.optics != nullptr)
      if (const auto point = view.optics->ground.at(c, row)) feet.push_back(*point);
  }
  if (!feet.empty()) piece.foot = median(std::move(feet), [](FloorPoint foot) { return norm(foot); });
  return piece;
}

/// Does the panel reach as high above the floor as a goal, where its foot stands?
bool has_goal_height(const View& view, const Piece& piece, double height) {
  if (piece.box.y0 == 0) return true;  // cut above
  const MountedCamera& camera = view.optics->camera;
  const auto top = height_at_range(camera, {(piece.box.x0 + piece.box.x1 - 1) / 2.0, piece.box.y0 - 0.5},
                                   distance(*piece.foot, foot_of(camera)));
  return top && *top > 0.4 * height && *top < 2 * height;
}

/// One end of the panel: a vertical edge.
struct End {
  double azimuth = 0;  ///< From the eye, robot frame. [rad]
  double sigma = 0;    ///< [rad]
  std::optional<FloorPoint> foot;
  double foot_sigma = 0;  ///< Along the sight. [m]
};

/// The left (side -1) or right (+1) end of the pieces; nothing where the border cuts it or a robot hides it.
std::optional<End> end_of(const View& view, const Region& goal, int side, const GoalOptions& options) {
  const MountedCamera& camera = view.optics->camera;
  struct RowEnd {
    int row, column;
  };
  RecycledVector<RowEnd> ends;  // outermost pixel of every row
  for (const PixelRun& run : goal.runs()) {
    const int column = side < 0 ? run.begin : run.end - 1;
    if (ends.empty() || ends.back().row != run.row)
      ends.push_back({run.row, column});
    else if (side > 0)
      ends.back().column = column;
  }
  if (ends.size() < 3) return std::nullopt;
  RecycledVector<double> azimuths;
  int hidden = 0, cut = 0;
  for (const RowEnd& end : ends) {
    const int beside = end.column + side;
    if (!view.inside(beside, end.row)) {
      ++cut;
      continue;
    }
    bool robot = false;
    for (int k = 1; k <= 3 && view.inside(end.column + side * k, end.row); ++k)
      robot = robot || view.is_robot(end.column + side * k, end.row);
    if (robot) {
      ++hidden;
      continue;
    }
    const PixelPoint rim{end.column + side * 0.5, static_cast<double>(end.row)};
    const auto edge = find_edge(view.frame, {.at = rim, .outward = {double(side), 0}, .reach_px = 3});
    const auto ray = view.optics->ray(edge.value_or(rim));
    if (!ray) continue;
    const double azimuth = std::atan2(ray->y, ray->x);
    // Near the first one, so that they can be ordered where azimuths jump from pi to -pi.
    azimuths.push_back(azimuths.empty() ? azimuth : azimuths[0] + std::remainder(azimuth - azimuths[0], 2 * pi));
  }
  const auto rows = static_cast<int>(ends.size());
  if (cut * 4 > rows || hidden * 2 > rows || azimuths.size() < 3) return std::nullopt;
  End end;
  // Vertical edges have one azimuth; the outermost ones are the post's (a far corner of the panel lies further in).
  std::ranges::sort(azimuths);
  const std::size_t n = azimuths.size();
  const auto half = static_cast<std::ptrdiff_t>((n + 1) / 2);
  end.azimuth = wrap_angle(median(side < 0 ? RecycledVector<double>(azimuths.end() - half, azimuths.end())
                                           : RecycledVector<double>(azimuths.begin(), azimuths.begin() + half)));
  end.sigma = options.edge_sigma_px / camera.model().fx;
  // The foot of the end: the lowest row whose outermost pixel lies at this azimuth and stands on the floor.
  for (auto it = ends.rbegin(); it != ends.rend(); ++it) {
    const auto ray = view.optics->ray({it->column + side * 0.5, static_cast<double>(it->row)});
    if (!ray || std::abs(wrap_angle(std::atan2(ray->y, ray->x) - end.azimuth)) > 3.0 / camera.model().fx) continue;
    const int below = it->row + 2;
    const int inward = it->column - side;
    if (view.inside(inward, below) && view.surface.is_floor(inward, below)) {
      const PixelPoint foot{static_cast<double>(it->column), it->row + 0.5};
      if (const auto seen = floor_gaussian(camera, foot, options.foot_sigma_px, view.optics->mount_sigma)) {
        end.foot = seen->mean;
        end.foot_sigma = std::sqrt(seen->covariance.trace());
      }
    }
    break;
  }
  return end;
}

struct Mouth {
  FloorPoint left, right;
};

/// The mouth of known width that fits both ends' bearings and feet best, by Gauss-Newton on (middle, direction).
std::optional<Mouth> fit_mouth(const View& view, const End& left, const End& right, double width) {
  const FloorPoint eye = foot_of(view.optics->camera);
  const double opening = wrap_angle(left.azimuth - right.azimuth);
  if (opening <= 0) return std::nullopt;
  const auto along = [&](double azimuth, double range) {
    return eye + FloorPoint{range * std::cos(azimuth), range * std::sin(azimuth)};
  };
  // Facing us, the mouth would be this far away.
  const double facing = width / 2 / std::tan(opening / 2);
  const FloorPoint l = left.foot.value_or(along(left.azimuth, facing));
  const FloorPoint r = right.foot.value_or(along(right.azimuth, facing));
  if (distance(l, r) < 0.1 * width) return std::nullopt;
  Eigen::Vector3d state((l.x + r.x) / 2, (l.y + r.y) / 2, std::atan2(l.y - r.y, l.x - r.x));
  // Up to two bearings, two feet and the direction.
  using Residuals = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 5, 1>;
  const auto residuals = [&](const Eigen::Vector3d& s) -> Residuals {
    std::array<double, 5> e{};
    Eigen::Index n = 0;
    for (const int side : {1, -1}) {
      const End& end = side > 0 ? left : right;
      const FloorPoint post{s[0] + side * width / 2 * std::cos(s[2]), s[1] + side * width / 2 * std::sin(s[2])};
      const FloorPoint seen = post - eye;
      e[static_cast<std::size_t>(n++)] = wrap_angle(std::atan2(seen.y, seen.x) - end.azimuth) / end.sigma;
      if (end.foot) e[static_cast<std::size_t>(n++)] = (norm(seen) - distance(*end.foot, eye)) / end.foot_sigma;
    }
    // Without feet the mouth is taken to face us, within half a right angle.
    e[static_cast<std::size_t>(n++)] =
        wrap_angle(s[2] - std::atan2(s[1] - eye.y, s[0] - eye.x) - radians(90)) / radians(45);
    return Eigen::Map<const Residuals>(e.data(), n);
  };
  for (int iteration = 0; iteration < 15; ++iteration) {
    const Residuals e = residuals(state);
    Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 5, 3> jacobian(e.size(), 3);
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector3d moved = state;
      constexpr double step = 1e-6;
      moved[k] += step;
      jacobian.col(k) = (residuals(moved) - e) / step;
    }
    Eigen::Matrix3d information = jacobian.transpose() * jacobian;
    information.diagonal() *= 1.0001;
    const Eigen::Vector3d step = -information.ldlt().solve(jacobian.transpose() * e);
    if (!step.allFinite()) return std::nullopt;
    state += step.cwiseMax(-0.5).cwiseMin(0.5);
    if (step.norm() < 1e-6) break;
  }
  if (std::hypot(state[0], state[1]) > 1.5 * longest_distance(view.field)) return std::nullopt;
  const FloorPoint half{width / 2 * std::cos(state[2]), width / 2 * std::sin(state[2])};
  const FloorPoint middle{state[0], state[1]};
  return Mouth{middle + half, middle - half};
}

/// Why a piece is no goal; empty if it is one.
std::string_view refusal_of(const View& view, const Piece& piece, const FieldModel::Goal& model,
                            const GoalOptions& options) {
  const int open = piece.columns - piece.hidden;
  if (piece.on_floor < std::max(2.0, options.min_foot_share * open)) return "does not stand on the floor"sv;
  if (view.optics == nullptr) return {};
  if (!piece.foot) return "stands where the floor is out of view"sv;
  if (norm(*piece.foot) > longest_distance(view.field)) return "stands off the field"sv;
  return has_goal_height(view, piece, model.height) ? ""sv : "is not as high as a goal where it stands"sv;
}

/// The goal of a color, or why there is none.
struct GoalVerdict {
  std::optional<Goal> goal;
  RecycledString why;
};
GoalVerdict goal_of(const View& view, GoalColor color, const FieldModel::Goal& model, const GoalOptions& options) {
  const ColorClass color_class = color == GoalColor::yellow ? ColorClass::yellow : ColorClass::blue;
  const Region joined = closing(view.segmentation.of(color_class), rectangle(3, 3));
  RecycledVector<Piece> standing, floating;
  for (Region& part : components(joined)) {
    if (area(part) < options.min_area_px) continue;
    Piece piece = piece_of(view, std::move(part));
    (refusal_of(view, piece, model, options).empty() ? standing : floating).push_back(std::move(piece));
  }
  if (standing.empty() && floating.empty()) return {{}, nothing_seen(to_string(color), options.min_area_px)};
  if (standing.empty()) {
    const Piece& largest = *std::ranges::max_element(floating, {}, [](const Piece& p) { return area(p.region); });
    return {{}, largest_refused(to_string(color), largest.region, refusal_of(view, largest, model, options))};
  }
  // The largest piece is the goal; others belong to it when together they are no wider than a goal.
  sort_stably(standing, std::greater<>{}, [](const Piece& p) { return area(p.region); });
  PixelBox box = standing.front().box;
  RecycledVector<Region> parts{standing.front().region};
  const auto widest_px = [&]() -> double {
    if (view.optics == nullptr) return 1.5 * box.width();
    const double range = std::max(0.3, distance(*standing.front().foot, foot_of(view.optics->camera)));
    return 1.3 * view.optics->camera.model().fx * model.width / range + 4;
  }();
  const auto take = [&](const RecycledVector<Piece>& pieces, std::size_t from, bool must_overlap_rows) {
    for (std::size_t i = from; i < pieces.size(); ++i) {
      const PixelBox both = hull(box, pieces[i].box);
      const bool rows = std::min(box.y1, pieces[i].box.y1) > std::max(box.y0, pieces[i].box.y0);
      const bool hidden_foot = pieces[i].hidden * 2 > pieces[i].columns;
      if (both.width() > widest_px || (must_overlap_rows && !(rows && hidden_foot))) continue;
      box = both;
      parts.push_back(pieces[i].region);
    }
  };
  take(standing, 1, false);
  take(floating, 0, true);

  Goal goal;
  goal.color = color;
  goal.box = box;
  if (view.optics == nullptr) return {goal, {}};
  const Region whole = union_of(parts);
  const auto left = end_of(view, whole, -1, options), right = end_of(view, whole, 1, options);
  if (left && right) {
    if (const auto mouth = fit_mouth(view, *left, *right, model.width)) {
      goal.position = 0.5 * (mouth->left + mouth->right);
      goal.bearing = bearing(*goal.position);
      goal.posts = {{PostSide::left, mouth->left}, {PostSide::right, mouth->right}};
      return {goal, {}};
    }
  }
  if (left && left->foot) goal.posts.push_back({PostSide::left, *left->foot});
  if (right && right->foot) goal.posts.push_back({PostSide::right, *right->foot});
  const MountedCamera& camera = view.optics->camera;
  const auto middle = floor_at_range(camera, {(box.x0 + box.x1 - 1) / 2.0, (box.y0 + box.y1 - 1) / 2.0},
                                     distance(*standing.front().foot, foot_of(camera)));
  if (middle) goal.bearing = bearing(*middle);
  return {goal, {}};
}

}  // namespace

void GoalOptions::check() const {
  if (min_area_px < 1) throw Error("goal.min_area_px", "is " + std::to_string(min_area_px) + ", must be >= 1");
  if (!(min_foot_share >= 0 && min_foot_share <= 1))
    throw Error("goal.min_foot_share", "is " + std::to_string(min_foot_share) + ", must be in [0, 1]");
  if (!(edge_sigma_px > 0)) throw Error("goal.edge_sigma_px", "is " + std::to_string(edge_sigma_px) + ", must be > 0");
  if (!(foot_sigma_px > 0)) throw Error("goal.foot_sigma_px", "is " + std::to_string(foot_sigma_px) + ", must be > 0");
}

GoalSearch search_goals(const View& view, const GoalOptions& options) {
  GoalSearch search;
  for (const GoalColor color : {GoalColor::yellow, GoalColor::blue}) {
    const auto model = std::ranges::find(view.field.goals, color, &FieldModel::Goal::color);
    if (model == view.field.goals.end()) continue;
    GoalVerdict verdict = goal_of(view, color, *model, options);
    if (verdict.goal)
      search.goals.push_back(std::move(*verdict.goal));
    else
      search.why.push_back(std::move(verdict.why));
  }
  if (view.field.goals.empty()) search.why.emplace_back("the field has no colored goals");
  return search;
}

RecycledVector<Goal> find_goals(const View& view, const GoalOptions& options) {
  return search_goals(view, options).goals;
}

}  // namespace tassilo
