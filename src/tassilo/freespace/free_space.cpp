#include "tassilo/freespace/free_space.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tassilo/base/contract.h"
#include "tassilo/base/error.h"
#include "tassilo/freespace/internal/ball_shape.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

SectorMap::Ray follow(const MountedCamera& camera, FloorPoint origin, double angle, double max_range) {
  SectorMap::Ray ray;
  const FloorPoint along{std::cos(angle), std::sin(angle)};
  const auto pixel_at = [&](double range) {
    const FloorPoint p = origin + range * along;
    return camera.project({p.x, p.y, 0});
  };
  const int width = camera.model().width, height = camera.model().height;
  double step = 0;
  bool entered = false;
  for (double range = 0.02; range <= max_range; range += step) {
    const auto pixel = pixel_at(range);
    // Beside the view a pixel may lie further off than a whole number holds.
    if (!pixel || !(pixel->x > -0.5 && pixel->x < width - 0.5 && pixel->y > -0.5 && pixel->y < height - 0.5)) {
      if (entered) return ray;  // left the view
      step = 0.01 * range;      // on the way to it
      continue;
    }
    entered = true;
    const auto c = static_cast<std::int16_t>(std::lround(pixel->x)),
               r = static_cast<std::int16_t>(std::lround(pixel->y));
    // Half a pixel further each time: no pixel on the way is missed.
    constexpr double ahead = 1e-3;
    const auto next = pixel_at(range + ahead);
    const double per_meter = next ? distance(*pixel, *next) / ahead : 0;
    step = std::clamp(0.5 / std::max(per_meter, 1e-9), 5e-4, 0.2);
    if (ray.steps.empty() || ray.steps.back().column != c || ray.steps.back().row != r)
      ray.steps.push_back({c, r, static_cast<float>(range)});
  }
  ray.is_in_view_to_the_end = entered;
  return ray;
}

/// Tells which steps share a tile.
void add_stretches(SectorMap::Ray& ray, int width) {
  const auto across = static_cast<std::uint32_t>((width + Surface::kTile - 1) / Surface::kTile);
  for (const SectorMap::Step& step : ray.steps) {
    const auto tile = static_cast<std::uint32_t>(step.row / Surface::kTile) * across +
                      static_cast<std::uint32_t>(step.column / Surface::kTile);
    if (ray.stretches.empty() || ray.stretches.back().tile != tile)
      ray.stretches.push_back({tile, ray.stretches.empty() ? 0 : ray.stretches.back().end, 0});
    ++ray.stretches.back().end;
    ray.stretches.back().range = step.range;
  }
}

struct RayEnd {
  SectorState state = SectorState::unseen;
  double range = 0;
};

class Walker {
 public:
  Walker(const SectorMap& map, const Surface& surface, std::span<const Ball> balls)
      : map_(map), surface_(surface), balls_(balls) {
    shapes_.reserve(balls.size());
    for (const Ball& ball : balls) shapes_.emplace_back(map.camera(), ball);
  }

  RayEnd operator()(const SectorMap::Ray& ray) const {
    if (ray.steps.empty()) return {};
    double free_until = 0;     // floor nearer than the view counts as free once the first pixel is
    bool behind_ball = false;  // the ball hides the floor from here on
    int odd = 0;               // pixels that are neither floor nor ball since the last floor
    std::size_t next = 0;
    for (const SectorMap::Stretch& stretch : ray.stretches) {
      if ((surface_.tiles[stretch.tile] & Surface::all_floor) != 0) {
        free_until = stretch.range;
        behind_ball = false;
        odd = 0;
        next = stretch.end;
        continue;
      }
      for (; next < stretch.end; ++next) {
        const SectorMap::Step& step = ray.steps[next];
        if (surface_.is_floor(step.column, step.row)) {
          free_until = step.range;
          behind_ball = false;
          odd = 0;
        } else if (on_ball(step.column, step.row)) {
          behind_ball = true;
        } else if (++odd > map_.options().noise_px) {
          // Directly behind the ball: the floor up to the obstacle is hidden, not seen.
          return {behind_ball ? SectorState::free : SectorState::blocked, free_until};
        }
      }
    }
    // The last pixel's floor goes on to the maximal range.
    if (ray.is_in_view_to_the_end && free_until == ray.steps.back().range) free_until = map_.options().max_range;
    return {odd > 0 && !behind_ball ? SectorState::blocked : SectorState::free, free_until};
  }

 private:
  bool on_ball(int column, int row) const {
    // With the shadow at its foot.
    for (const Ball& ball : balls_)
      if (column >= ball.box.x0 && column < ball.box.x1 && row >= ball.box.y0 && row < ball.box.y1) return true;
    constexpr double kRim = 2;  // of mixed colors: one sample of chroma spans two columns [px]
    const PixelPoint pixel{static_cast<double>(column), static_cast<double>(row)};
    return std::ranges::any_of(shapes_, [&](const BallShape& shape) { return shape.covers(pixel, kRim); });
  }

  const SectorMap& map_;
  const Surface& surface_;
  std::span<const Ball> balls_;
  RecycledVector<BallShape> shapes_;  ///< Of the balls.
};

}  // namespace

void FreeSpaceOptions::check() const {
  const auto in = [](const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high))
      throw Error(std::string("free_space.") + name, "is " + std::to_string(value) + ", must be in [" +
                                                         std::to_string(low) + ", " + std::to_string(high) + "]");
  };
  in("sector_deg", sector_deg, 0.1, 90);
  in("rays", rays, 1, 99);
  in("max_range", max_range, 0.01, 1000);
  in("noise_px", noise_px, 0, 100);
}

SectorMap::SectorMap(const MountedCamera& camera, const FreeSpaceOptions& options)
    : camera_(camera), options_(options), origin_{camera.center().x, camera.center().y} {
  options_.check();
  angle_increment_ = radians(options_.sector_deg);
  // Only directions the camera can see. The circle is cut open behind the camera, wherever that looks.
  const auto count = static_cast<int>(std::floor(2 * std::numbers::pi / angle_increment_ + 1e-9));
  const int lowest = static_cast<int>(std::lround(camera.mount().yaw / angle_increment_)) - count / 2;
  int first = count, last = -1;
  RecycledVector<RecycledVector<Ray>> all(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    auto& rays = all[static_cast<std::size_t>(k)];
    bool seen = false;
    for (int i = 0; i < options_.rays; ++i) {
      const double offset = (i + 0.5) / options_.rays - 0.5;
      rays.push_back(follow(camera, origin_, (lowest + k + offset) * angle_increment_, options_.max_range));
      add_stretches(rays.back(), camera.model().width);
      seen = seen || !rays.back().steps.empty();
    }
    if (!seen) continue;
    first = std::min(first, k);
    last = std::max(last, k);
  }
  if (last < 0) return;
  angle_min_ = wrap_angle((lowest + first) * angle_increment_);
  for (int k = first; k <= last; ++k)
    for (Ray& ray : all[static_cast<std::size_t>(k)]) rays_.push_back(std::move(ray));
}

FreeSpace find_free_space(const SectorMap& map, const Surface& surface, std::span<const Ball> balls) {
  expects(surface.width == map.camera().model().width && surface.height == map.camera().model().height,
          "free space: the surface is of an image of the map's camera");
  expects(surface.tiles.size() == static_cast<std::size_t>(surface.tiles_across() * surface.tiles_down()),
          "free space: the surface's tiles are up to date");
  FreeSpace space;
  space.states.reserve(map.sectors());
  space.ranges.reserve(map.sectors());
  space.origin = map.origin();
  space.angle_min = map.angle_min();
  space.angle_increment = map.angle_increment();
  const Walker walk(map, surface, balls);
  for (std::size_t sector = 0; sector < map.sectors(); ++sector) {
    RayEnd shortest;
    for (const SectorMap::Ray& ray : map.rays(sector)) {
      const RayEnd end = walk(ray);
      if (end.state == SectorState::unseen) continue;
      if (shortest.state == SectorState::unseen || end.range < shortest.range) shortest = end;
    }
    space.states.push_back(shortest.state);
    space.ranges.push_back(shortest.range);
  }
  return space;
}

}  // namespace tassilo
