#include "tassilo/detect/ball.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tassilo/base/error.h"
#include "tassilo/base/sort_stably.h"
#include "tassilo/detect/edge.h"
#include "tassilo/detect/internal/refusal.h"
#include "tassilo/detect/sphere_fit.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/region/algebra.h"
#include "tassilo/region/components.h"
#include "tassilo/region/features.h"
#include "tassilo/region/fill.h"
#include "tassilo/region/morphology.h"
#include "tassilo/region/raster.h"
#include "tassilo/region/relation.h"

namespace tassilo {
namespace {

using namespace std::string_view_literals;

ColorClass ball_color(const FieldModel& field) { return color_class_from(field.ball.color).value_or(ColorClass::red); }

/// A place on the rim of a segment: between a pixel inside and its neighbor outside.
struct RimPoint {
  PixelPoint at;
  bool hidden = false;  ///< A robot begins there: the ball may go on behind it.
};

/// Calls visit(c) for each column of a run that is in none of `others`, the runs of a row beside it.
template <class Visit>
void for_each_open(const PixelRun& run, std::span<const PixelRun> others, Visit visit) {
  int c = run.begin;
  for (const PixelRun& other : others) {
    for (; c < std::min(other.begin, run.end); ++c) visit(c);
    c = std::max<int>(c, other.end);
  }
  for (; c < run.end; ++c) visit(c);
}

/// Rim of a segment without what the image border cuts. O(pixels of the rim + products of the numbers of runs in
/// neighboring rows).
RecycledVector<RimPoint> rim_of(const View& view, const Region& segment) {
  RecycledVector<RimPoint> rim;
  const auto add = [&](int c, int r, int dc, int dr) {
    if (!view.inside(c + dc, r + dr)) return;
    // One pixel of mixed color may lie between ball and robot.
    const bool hidden =
        view.is_robot(c + dc, r + dr) || (view.inside(c + 2 * dc, r + 2 * dr) && view.is_robot(c + 2 * dc, r + 2 * dr));
    rim.push_back({{c + dc / 2.0, r + dr / 2.0}, hidden});
  };
  const auto runs = segment.runs();
  std::span<const PixelRun> above;
  for (std::size_t i = 0; i < runs.size();) {
    const auto row_at = [&](std::size_t from) { return runs.subspan(from, row_end(runs, from) - from); };
    const auto here = row_at(i);
    i += here.size();
    const int row = here.front().row;
    std::span<const PixelRun> below;
    if (i < runs.size() && runs[i].row == row + 1) below = row_at(i);
    if (!above.empty() && above.front().row != row - 1) above = {};
    for (const PixelRun& run : here) {
      add(run.begin, row, -1, 0);
      add(run.end - 1, row, 1, 0);
      for_each_open(run, above, [&](int c) { add(c, row, 0, -1); });
      for_each_open(run, below, [&](int c) { add(c, row, 0, 1); });
    }
    above = here;
  }
  return rim;
}

/// How a segment is looked at: with the mount as calibrated, or with the robot nodding; with or without the rim where a
/// robot's colors begin.
struct Attempt {
  const MountedCamera& camera;
  double nod_sigma = 0;  ///< Of the camera's pitch, beyond what the mount's calibration leaves. [rad]
  bool with_hidden = false;
};

/// Enough of the rim for a first fit, evenly thinned.
RecycledVector<RobotPoint> rays_of(const View& view, const Attempt& attempt, const RecycledVector<RimPoint>& rim) {
  constexpr std::size_t enough = 64;
  const std::size_t step = std::max<std::size_t>(1, rim.size() / enough);
  RecycledVector<RobotPoint> rays;
  for (std::size_t i = 0; i < rim.size(); i += step)
    if (attempt.with_hidden || !rim[i].hidden)
      if (const auto ray = view.optics->rays.at(rim[i].at)) rays.push_back(attempt.camera.robot_from_optical(*ray));
  return rays;
}

/// A first guess: the middle of the segment at the ball's height above the floor; if its ray does not go down that far,
/// as far away as its size says.
std::optional<RestingSphere> first_guess(const View& view, const MountedCamera& camera, const PixelBox& box) {
  const double radius = view.field.ball.radius.middle();
  const PixelPoint middle{(box.x0 + box.x1 - 1) / 2.0, (box.y0 + box.y1 - 1) / 2.0};
  const double furthest = longest_distance(view.field);
  if (camera.center().z > radius)
    if (const auto foot = camera.floor_point(middle, radius, 2 * furthest)) return RestingSphere{*foot, radius};
  const auto left = camera.ray({box.x0 - 0.5, middle.y}), right = camera.ray({box.x1 - 0.5, middle.y});
  if (!left || !right) return std::nullopt;
  const double half = std::acos(std::clamp(dot(*left, *right), -1.0, 1.0)) / 2;
  const double range = std::min(radius / std::max(std::sin(half), 1e-3), furthest);
  const auto foot = floor_at_range(camera, middle, range);
  if (!foot) return std::nullopt;
  return RestingSphere{*foot, radius};
}

/// Rays through sub-pixel edges along the outline of a sphere that shows as a disc of this radius; left out: beyond the
/// border and where a robot hides the rim.
RecycledVector<RobotPoint> outline_rays(const View& view, const Attempt& attempt, const RestingSphere& sphere,
                                        double radius_px) {
  RecycledVector<RobotPoint> rays;
  // Far enough for both plateaus, near enough to stay on the ball and beside it.
  const double reach = std::clamp(0.35 * radius_px, 2.0, 4.0);
  const int count = static_cast<int>(std::clamp(2 * std::numbers::pi * radius_px, 16.0, 64.0));
  for (const OutlinePoint& p : outline(attempt.camera, sphere, count)) {
    bool usable = true;
    for (const double along : {-reach, 1.0, reach}) {
      const auto q = pixel_of(view, p.at + along * p.outward);
      usable = usable && q && (attempt.with_hidden || along < 0 || !view.is_robot(q->column, q->row));
    }
    if (!usable) continue;
    const auto edge = find_edge(view.frame, {.at = p.at, .outward = p.outward, .reach_px = reach});
    if (!edge) continue;
    if (const auto ray = view.optics->rays.at(*edge)) rays.push_back(attempt.camera.robot_from_optical(*ray));
  }
  return rays;
}

/// What the image shows of a sphere's disc.
struct DiscView {
  int disc = 0;                         ///< Pixels of the disc in the image.
  int own = 0;                          ///< Of these, the ball's color.
  int hidden = 0;                       ///< Of these, robot colors.
  int clipped = 0;                      ///< Pixels of the disc outside the image.
  int foot = 0;                         ///< Points below the lower rim in the image.
  int foot_floor = 0, foot_hidden = 0;  ///< Of these, on the floor; on a robot.
};

DiscView look_at_disc(const View& view, const RecycledVector<OutlinePoint>& rim) {
  DiscView look;
  RecycledVector<PixelPoint> polygon;
  for (const OutlinePoint& p : rim) {
    polygon.push_back(p.at);
    if (p.outward.y < 0.5) continue;  // the lower third of the rim
    for (const double along : {2.0, 3.0}) {
      const auto q = pixel_of(view, p.at + along * p.outward);
      if (!q) continue;
      ++look.foot;
      look.foot_floor += view.surface.is_floor(q->column, q->row);
      look.foot_hidden += view.is_robot(q->column, q->row);
    }
  }
  const int w = view.segmentation.width, h = view.segmentation.height;
  const Region whole = region_from_polygon(polygon, {-w, -h, 2 * w, 2 * h}), disc = clipped(whole, {0, 0, w, h});
  look.disc = static_cast<int>(area(disc));
  look.clipped = static_cast<int>(area(whole)) - look.disc;
  look.own = static_cast<int>(common_area(disc, view.segmentation.of(ball_color(view.field))));
  for (const ColorClass color : kColorClasses)
    if (view.is_robot(color)) look.hidden += static_cast<int>(common_area(disc, view.segmentation.of(color)));
  return look;
}

/// Distance from the eye's foot at which the lower tangent to a resting sphere goes down by `depression`: the centre,
/// d ahead and `down` below the eye, lies one radius above the line of sight, d sin - down cos = radius. [m]
double tangent_distance(double eye_height, double radius, double depression) {
  constexpr double furthest = 1e3;
  const double down = eye_height - radius;
  // With the eye below the ball's centre no tangent starts nearer than where the ball would touch the eye.
  const double nearest = std::max(1e-3, std::sqrt(std::max(0.0, radius * radius - down * down)));
  const double sine = std::sin(depression);
  if (!(sine > 0)) return furthest;
  return std::clamp((radius + down * std::cos(depression)) / sine, nearest, furthest);
}

/// DESIGN 6.5: the lowest pixel of the segment below the centre bounds the distance from above, the highest pixel of
/// floor below it from below. Nothing where either is hidden or cut.
std::optional<DistanceBounds> tangent_bounds(const View& view, const MountedCamera& camera, const SphereFit& fit) {
  const auto bottom = lowest_of_outline(camera, fit.sphere);
  if (!bottom) return std::nullopt;
  const OutlinePoint& lowest = *bottom;
  const ColorClass own_color = ball_color(view.field);
  std::optional<PixelPoint> last_own, first_floor;
  for (double along = -3; along <= 6; along += 0.25) {
    const PixelPoint p = lowest.at + along * lowest.outward;
    const auto pixel = pixel_of(view, p);
    if (!pixel) return std::nullopt;
    const ColorClass color = view.color(pixel->column, pixel->row);
    if (color == own_color) {
      last_own = p;
    } else if (view.is_robot(color)) {
      return std::nullopt;
    } else if (last_own && view.surface.is_floor(pixel->column, pixel->row)) {
      first_floor = p;
      break;
    }
  }
  if (!last_own || !first_floor) return std::nullopt;
  // A pixel counts with its whole extent: the rim may cross it anywhere.
  constexpr double half_px = 0.5;
  const auto upper = camera.ray(*last_own - half_px * lowest.outward);
  const auto lower = camera.ray(*first_floor + half_px * lowest.outward);
  if (!upper || !lower) return std::nullopt;
  const double heading = std::atan2(fit.sphere.foot.y - camera.center().y, fit.sphere.foot.x - camera.center().x);
  const auto from_robot = [&](RobotPoint ray, double radius) {
    const double depression = std::atan2(-ray.z, std::hypot(ray.x, ray.y));
    const double d = tangent_distance(camera.center().z, radius, depression);
    return norm(FloorPoint{camera.center().x + d * std::cos(heading), camera.center().y + d * std::sin(heading)});
  };
  const Interval radius = view.field.ball.radius;
  const double a = from_robot(*upper, radius.low), b = from_robot(*upper, radius.high);
  const double c = from_robot(*lower, radius.low), d = from_robot(*lower, radius.high);
  return DistanceBounds{std::min({a, b, c, d}), std::max({a, b, c, d})};
}

/// Could a segment in this box be a ball that rests on the floor? Rough, to save the fit for those that could.
bool has_plausible_size(const View& view, const MountedCamera& camera, const PixelBox& box) {
  const auto guess = first_guess(view, camera, box);
  if (!guess || norm(guess->foot) > 1.5 * longest_distance(view.field)) return false;
  const auto disc = project_disc(camera, *guess);
  if (!disc) return true;  // so near that it surrounds the camera's axis
  return std::max(box.width(), box.height()) <= 2 * 1.7 * disc->radius_px + 4;
}

std::optional<SphereFit> fit_segment(const View& view, const Attempt& attempt, const RecycledVector<RimPoint>& rim,
                                     const PixelBox& box, const BallOptions& options) {
  const auto guess = first_guess(view, attempt.camera, box);
  if (!guess) return std::nullopt;
  const auto coarse_rays = rays_of(view, attempt, rim);
  if (coarse_rays.size() < 3) return std::nullopt;
  SphereFitOptions fitting{.radius = view.field.ball.radius,
                           .edge_sigma_px = 1.0,
                           .iterations = 20,
                           .furthest = 2 * longest_distance(view.field)};
  auto fit = fit_resting_sphere(attempt.camera, coarse_rays, *guess, fitting);
  if (!fit) return std::nullopt;
  auto disc = project_disc(attempt.camera, fit->sphere);
  if (!disc || fit->rms_px > std::max(1.5, 0.25 * disc->radius_px)) return std::nullopt;
  fitting.edge_sigma_px = options.edge_sigma_px;
  for (int round = 0; round < 2 && disc; ++round) {
    const auto rays = outline_rays(view, attempt, fit->sphere, disc->radius_px);
    if (rays.size() < 6) break;
    if (const auto finer = fit_resting_sphere(attempt.camera, rays, fit->sphere, fitting)) fit = finer;
    // Edges were looked for around the outline of before: where that was near enough, looking again finds the same.
    constexpr double near_px = 0.2;
    const auto moved = project_disc(attempt.camera, fit->sphere);
    if (moved && distance(moved->center, disc->center) + std::abs(moved->radius_px - disc->radius_px) < near_px) break;
    disc = moved;
  }
  return fit;
}

Verdict<Ball> try_ball(const View& view, const Attempt& attempt, const Region& segment,
                       const RecycledVector<RimPoint>& rim, const BallOptions& options) {
  const PixelBox box = bounding_box(segment);
  const MountedCamera& camera = attempt.camera;
  const auto fit = fit_segment(view, attempt, rim, box, options);
  if (!fit) return "has no rim that fits a ball on the floor"sv;
  constexpr int corners = 48;  // of the disc as a polygon
  const auto around = outline(camera, fit->sphere, corners);
  const auto disc = disc_of(camera, fit->sphere, around, corners);
  if (!disc) return "is where a ball does not show as a disc"sv;
  const double distance_m = norm(fit->sphere.foot);
  if (distance_m > longest_distance(view.field)) return "would be a ball off the field"sv;
  const DiscView look = look_at_disc(view, around);
  const int open_disc = look.disc - look.hidden;
  if (look.own < options.min_area_px || look.own < options.min_cover * open_disc)
    return "covers too little of the ball that would fit it"sv;
  const int whole = look.disc + look.clipped;
  if (look.own < 0.03 * whole) return "shows too little of a ball"sv;  // a crescent too thin for any shape
  // The segment must be about as large as the disc: a shirt that fills it and goes on is none.
  if (area(segment) > 1.6 * look.own + 8) return "goes on beyond the ball that would fit it"sv;
  const bool cut = look.clipped > 0 || look.hidden > 0;
  if (!cut && (box.width() < options.min_width * 2 * disc->radius_px - 1 ||
               box.height() < options.min_height * 2 * disc->radius_px - 1))
    return "is smaller than the ball that would fit it"sv;
  // It rests on the floor: carpet shows below it, unless something hides its foot.
  const int foot_open = look.foot - look.foot_hidden;
  const double foot_share = foot_open > 0 ? static_cast<double>(look.foot_floor) / foot_open : 0.5;
  if (foot_open > 0 && foot_share < 0.4) return "has no carpet below it"sv;

  Ball ball;
  ball.box = box;
  ball.center = disc->center;
  ball.radius_px = disc->radius_px;
  const double cover = open_disc > 0 ? static_cast<double>(look.own) / open_disc : 0;
  const double seen = static_cast<double>(look.own) / std::max(1, whole);
  const double roundness = std::exp(-fit->rms_px * fit->rms_px / (0.08 * disc->radius_px * disc->radius_px + 0.5));
  // Nodding excuses much: half of the trust.
  const double steady = attempt.nod_sigma > 0 ? 0.5 : 1;
  ball.confidence = std::clamp(steady * cover * roundness * (0.5 + 0.5 * foot_share) * (0.4 + 0.6 * seen), 0.0, 1.0);

  BallOnFloor floor;
  floor.position.mean = fit->sphere.foot;
  floor.position.covariance = fit->covariance.topLeftCorner<2, 2>();
  MountSigma mount_sigma = view.optics->mount_sigma;
  mount_sigma.pitch = std::hypot(mount_sigma.pitch, attempt.nod_sigma);
  if (const auto common =
          floor_gaussian(camera, disc->center, options.common_sigma_px, mount_sigma, fit->sphere.radius))
    floor.position.covariance += common->covariance;
  const Eigen::Vector2d sight(fit->sphere.foot.x / distance_m, fit->sphere.foot.y / distance_m);
  const double sigma = std::sqrt(sight.dot(floor.position.covariance * sight));
  floor.bounds = {std::max(0.0, distance_m - options.bound_sigmas * sigma), distance_m + options.bound_sigmas * sigma};
  if (const auto bounds = tangent_bounds(view, camera, *fit)) {
    floor.bounds.near = std::min(bounds->near, floor.bounds.near);
    floor.bounds.far = std::max(bounds->far, floor.bounds.far);
  }
  ball.floor = floor;
  return ball;
}

/// Might the segment stand on the floor? Below its lowest pixels there is floor, something that may hide it, or no more
/// image.
bool may_stand(const View& view, const PixelBox& box) {
  for (int r = box.y1; r < box.y1 + 4; ++r)
    for (int c = box.x0 + box.width() / 4; c <= box.x1 - 1 - box.width() / 4; ++c)
      if (!view.inside(c, r) || view.surface.is_floor(c, r) || view.is_robot(c, r)) return true;
  return false;
}

/// With the mount as calibrated.
Verdict<Ball> steady_ball(const View& view, const Region& segment, const BallOptions& options) {
  const MountedCamera& camera = view.optics->camera;
  if (!has_plausible_size(view, camera, bounding_box(segment)))
    return "is too large for a ball there, or further away than the field is long"sv;
  const RecycledVector<RimPoint> rim = rim_of(view, fill_holes(segment));
  const auto open = static_cast<std::size_t>(std::ranges::count(rim, false, &RimPoint::hidden));
  // A robot behind the ball looks like one before it: with hardly any open rim, every point of it is better than none.
  const bool hardly_open = open < std::max<std::size_t>(6, rim.size() / 4);
  Verdict<Ball> ball = try_ball(view, {.camera = camera, .with_hidden = hardly_open}, segment, rim, options);
  if (ball.object || hardly_open || open == rim.size()) return ball;
  return try_ball(view, {.camera = camera, .with_hidden = true}, segment, rim, options);
}

/// With the robot nodding, the smallest angle that explains the segment.
Verdict<Ball> nodding_ball(const View& view, std::span<const MountedCamera> nodding, const Region& segment,
                           const BallOptions& options) {
  RecycledVector<RimPoint> rim;
  for (const MountedCamera& camera : nodding) {
    if (!has_plausible_size(view, camera, bounding_box(segment))) continue;
    if (rim.empty()) rim = rim_of(view, fill_holes(segment));
    const Attempt attempt{.camera = camera, .nod_sigma = radians(options.nod_step_deg), .with_hidden = true};
    if (Verdict<Ball> ball = try_ball(view, attempt, segment, rim, options); ball.object) return ball;
  }
  return "fits no ball while the robot nods"sv;
}

/// The camera as it may look while the robot shakes, small angles first.
RecycledVector<MountedCamera> nodding_cameras(const MountedCamera& camera, const BallOptions& options) {
  RecycledVector<MountedCamera> cameras;
  for (double nod = options.nod_step_deg; nod <= options.max_nod_deg + 1e-9; nod += options.nod_step_deg)
    for (const double sign : {1.0, -1.0}) {
      CameraMount mount = camera.mount();
      mount.pitch += sign * radians(nod);
      cameras.emplace_back(camera.model(), mount);
    }
  return cameras;
}

/// Without a camera: round, and carpet below.
Verdict<Ball> ball_in_image(const View& view, const Region& segment, const BallOptions& options) {
  const Region filled = fill_holes(segment);
  const std::int64_t pixels = area(filled);
  if (pixels < 3 * options.min_area_px) return "is too small to be told round"sv;
  const PixelBox box = bounding_box(filled);
  const ShapeFeatures shape = shape_features(filled);
  // An ideal disc has anisometry 1; cut by the border or partly hidden it may reach 2.
  const bool cut =
      box.x0 == 0 || box.y0 == 0 || box.x1 == view.segmentation.width || box.y1 == view.segmentation.height;
  // (0: all pixels on one line)
  if (shape.anisometry < 1 || shape.anisometry > (cut ? 2.5 : 1.6)) return "is longer than a disc"sv;
  const double fill = static_cast<double>(pixels) / static_cast<double>(box.area());
  if (fill < 0.6) return "fills less of its box than a disc"sv;  // pi / 4 for a disc
  int floor = 0, below = 0;
  for (int c = box.x0; c < box.x1; ++c)
    for (const int r : {box.y1 + 1, box.y1 + 2})
      if (view.inside(c, r)) {
        ++below;
        floor += view.surface.is_floor(c, r);
      }
  // With carpet in view a ball lies on it; without any, its shape is all there is.
  if (below > 0 && floor == 0 && !view.segmentation.of(ColorClass::green).empty()) return "has no carpet below it"sv;
  const double foot_share = below > 0 ? static_cast<double>(floor) / below : 0.5;
  Ball ball;
  ball.box = box;
  ball.center = {(box.x0 + box.x1 - 1) / 2.0, (box.y0 + box.y1 - 1) / 2.0};
  ball.radius_px = std::sqrt(static_cast<double>(pixels) / std::numbers::pi);
  ball.confidence = std::clamp((0.2 + 0.8 * foot_share) / shape.anisometry * std::min(1.0, fill / 0.75), 0.0, 1.0);
  return ball;
}

}  // namespace

void BallOptions::check() const {
  const auto share = [](const char* name, double value) {
    if (!(value >= 0 && value <= 1))
      throw Error(std::string("ball.") + name, "is " + std::to_string(value) + ", must be in [0, 1]");
  };
  const auto positive = [](const char* name, double value) {
    if (!(value > 0)) throw Error(std::string("ball.") + name, "is " + std::to_string(value) + ", must be > 0");
  };
  positive("min_area_px", min_area_px);
  positive("max_balls", max_balls);
  share("min_width", min_width);
  share("min_height", min_height);
  share("min_cover", min_cover);
  positive("edge_sigma_px", edge_sigma_px);
  positive("common_sigma_px", common_sigma_px);
  positive("bound_sigmas", bound_sigmas);
  positive("nod_step_deg", nod_step_deg);
  if (!(max_nod_deg >= 0 && max_nod_deg <= 10))
    throw Error("ball.max_nod_deg", "is " + std::to_string(max_nod_deg) + ", must be in [0, 10]");
}

BallSearch search_balls(const View& view, const BallOptions& options) {
  // A line before or a highlight on the ball may split it by a pixel.
  const ColorClass color = ball_color(view.field);
  const Region joined = closing(view.segmentation.of(color), rectangle(3, 3));
  RecycledVector<Region> segments = components(joined);
  std::erase_if(segments, [&](const Region& segment) {
    // One sample of chroma spans two columns: what is no wider is one sample's noise.
    return area(segment) < options.min_area_px || bounding_box(segment).width() < 3;
  });
  if (segments.empty())
    return {.balls = {}, .why = nothing_seen(to_string(color), options.min_area_px) + " and 3 columns"};
  sort_stably(segments, std::greater<>{}, [](const Region& segment) { return area(segment); });
  RecycledVector<Ball> balls;
  std::string_view refusal;  // of the largest segment
  const auto collect = [&](auto look) {
    for (const Region& segment : segments) {
      Verdict<Ball> ball = look(segment);
      if (ball.object)
        balls.push_back(std::move(*ball.object));
      else if (refusal.empty())
        refusal = ball.refusal;
    }
  };
  if (view.optics == nullptr) {
    collect([&](const Region& segment) { return ball_in_image(view, segment, options); });
  } else {
    const auto stands = [&](const Region& segment) { return may_stand(view, bounding_box(segment)); };
    if (std::ranges::none_of(segments, stands))
      return {.balls = {}, .why = largest_refused(to_string(color), segments.front(), "does not stand on the floor")};
    std::erase_if(segments, std::not_fn(stands));
    collect([&](const Region& segment) { return steady_ball(view, segment, options); });
    // A ball that fits the mount as calibrated says that the robot does not nod.
    if (balls.empty()) {
      const RecycledVector<MountedCamera> nodding = nodding_cameras(view.optics->camera, options);
      collect([&](const Region& segment) { return nodding_ball(view, nodding, segment, options); });
    }
  }
  if (balls.empty()) return {.balls = {}, .why = largest_refused(to_string(color), segments.front(), refusal)};
  sort_stably(balls, std::greater<>{}, &Ball::confidence);
  // Two pieces of one ball are one ball.
  RecycledVector<Ball> kept;
  for (Ball& ball : balls) {
    const bool same = std::ranges::any_of(kept, [&](const Ball& other) {
      return distance(other.center, ball.center) < std::max(other.radius_px, ball.radius_px);
    });
    if (!same && kept.size() < static_cast<std::size_t>(options.max_balls)) kept.push_back(std::move(ball));
  }
  return {.balls = std::move(kept), .why = {}};
}

RecycledVector<Ball> find_balls(const View& view, const BallOptions& options) {
  return search_balls(view, options).balls;
}

}  // namespace tassilo
