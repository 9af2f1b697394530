#include "tassilo/freespace/free_space.h"

#include <gtest/gtest.h>

#include <random>
#include <span>
#include <utility>

#include "tassilo/base/error.h"
#include "tassilo/camera/test_world.h"
#include "tassilo/freespace/internal/ball_shape.h"
#include "tassilo/freespace/test_ball.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

using test::World;

/// The surface straight from the world's geometry: what the walker makes of perfect colors.
struct Known {
  Known(const MountedCamera& camera, const World& world) {
    const int width = camera.model().width, height = camera.model().height;
    surface.width = width;
    surface.height = height;
    for (int r = 0; r < height; ++r)
      for (int c = 0; c < width; ++c) {
        const auto ray = camera.ray({double(c), double(r)});
        const test::Paint paint = ray ? test::look(world, camera.center(), *ray) : test::kHall;
        const bool floor = ray && ray->z < 0 && (paint.u == test::kCarpet.u || paint.u == test::kWhite.u) &&
                           camera.center().x - camera.center().z / ray->z * ray->x < world.wall_x &&
                           paint.u != test::kWhite.u;
        surface.kinds.push_back(floor ? SurfaceKind::carpet : SurfaceKind::object);
      }
    surface.update_tiles();
  }
  Surface surface;
};

/// Where the direction meets the wall or the first robot, from the point under the camera. [m]
double true_range(const World& world, FloorPoint origin, double angle) {
  const double cosine = std::cos(angle), sine = std::sin(angle);
  double range = cosine > 1e-9 ? (world.wall_x - origin.x) / cosine : 1e9;
  for (const test::Cylinder& robot : world.robots) {
    const double dx = robot.foot.x - origin.x, dy = robot.foot.y - origin.y;
    const double along = dx * cosine + dy * sine, off = dx * dx + dy * dy - along * along;
    if (along > 0 && off < robot.radius * robot.radius)
      range = std::min(range, along - std::sqrt(robot.radius * robot.radius - off));
  }
  return range;
}

/// One line of sight, step by step and without tiles: state and range.
std::pair<SectorState, double> plain_walk(const SectorMap& map, const SectorMap::Ray& ray, const Surface& surface,
                                          const Ball& ball) {
  const BallShape shape(map.camera(), ball);
  double free_until = 0;
  bool behind_ball = false;
  int odd = 0;
  for (const SectorMap::Step& step : ray.steps) {
    if (surface.is_floor(step.column, step.row)) {
      free_until = step.range;
      behind_ball = false;
      odd = 0;
    } else if (shape.covers({double(step.column), double(step.row)}, 2)) {
      behind_ball = true;
    } else if (++odd > map.options().noise_px) {
      return {behind_ball ? SectorState::free : SectorState::blocked, free_until};
    }
  }
  if (!ray.steps.empty() && ray.is_in_view_to_the_end && free_until == ray.steps.back().range)
    free_until = map.options().max_range;
  return {odd > 0 && !behind_ball ? SectorState::blocked : SectorState::free, free_until};
}

TEST(FindFreeSpace, OverTilesEqualsStepByStep) {
  std::mt19937 random(1);
  for (const MountedCamera& camera : test::cameras()) {
    SCOPED_TRACE(camera.model().width);
    const SectorMap map(camera, {.rays = 1});
    Known known(camera, World{});
    Ball ball;
    ball.center = {camera.model().width / 2.0, camera.model().height * 0.7};
    ball.radius_px = 9.3;
    for (int round = 0; round < 20; ++round) {
      Surface surface = known.surface;
      for (int spot = 0; spot < 8 * round; ++spot) {
        const int c = static_cast<int>(random() % static_cast<unsigned>(surface.width - 6));
        const int r = static_cast<int>(random() % static_cast<unsigned>(surface.height - 6));
        const int size = 1 + static_cast<int>(random() % 6);
        for (int y = r; y < r + size; ++y)
          for (int x = c; x < c + size; ++x)
            surface.kinds[static_cast<std::size_t>(y * surface.width + x)] = SurfaceKind::wall;
      }
      surface.update_tiles();
      const FreeSpace space = find_free_space(map, surface, std::span(&ball, 1));
      for (std::size_t i = 0; i < map.sectors(); ++i) {
        if (map.rays(i)[0].steps.empty()) continue;
        const auto [state, range] = plain_walk(map, map.rays(i)[0], surface, ball);
        EXPECT_EQ(space.states[i], state) << i;
        EXPECT_EQ(space.ranges[i], range) << i;
      }
    }
  }
}

TEST(FindFreeSpace, NeverClaimsMoreThanThereIsAndSeesWhatBlocks) {
  for (const MountedCamera& camera : test::cameras()) {
    SCOPED_TRACE(camera.model().width);
    World world;
    world.wall_x = 3;
    world.robots.push_back({.foot = {1.6, 0.3}});
    const Known known(camera, world);
    const SectorMap map(camera, {});
    const FreeSpace space = find_free_space(map, known.surface, {});
    ASSERT_EQ(space.ranges.size(), space.states.size());
    ASSERT_GT(space.ranges.size(), 20u);
    int blocked = 0;
    for (std::size_t i = 0; i < space.ranges.size(); ++i) {
      const double angle = space.angle_min + static_cast<double>(i) * space.angle_increment;
      const double truth = true_range(world, space.origin, angle);
      if (space.states[i] == SectorState::unseen) continue;
      EXPECT_LE(space.ranges[i], 1.02 * truth + 0.02) << degrees(angle) << " deg";
      if (space.states[i] != SectorState::blocked) continue;
      ++blocked;
      double shortest = truth;
      for (double part = -0.5; part <= 0.5; part += 0.1)
        shortest = std::min(shortest, true_range(world, space.origin, angle + part * space.angle_increment));
      // Further away a pixel is a tenth of the distance and more.
      if (shortest > 4) continue;
      EXPECT_GE(space.ranges[i], 0.9 * shortest - 0.05) << degrees(angle) << " deg";
    }
    EXPECT_GT(blocked, 20);
  }
}

TEST(FindFreeSpace, TheBallIsNoObstacleButHidesTheFloorBehindIt) {
  const MountedCamera camera = test::cameras()[1];
  World world;
  world.wall_x = 4;
  const FloorPoint place{1.5, 0.0};
  world.spheres.push_back({{place.x, place.y, 0.1}, 0.1});
  const Known known(camera, world);
  Ball ball;
  ball.center = camera.project({place.x, place.y, 0.1}).value();
  ball.radius_px = 0.1 / 1.4 * camera.model().fx;
  const SectorMap map(camera, {});
  const auto range_ahead = [&](std::span<const Ball> balls) {
    const FreeSpace space = find_free_space(map, known.surface, balls);
    const auto i = static_cast<std::size_t>(std::lround(-space.angle_min / space.angle_increment));
    return std::pair(space.states[i], space.ranges[i]);
  };
  const auto [with_state, with_range] = range_ahead(std::span(&ball, 1));
  EXPECT_EQ(with_state, SectorState::blocked);  // floor is seen again behind it, up to the wall
  EXPECT_NEAR(with_range, 4 - camera.center().x, 0.15);
  const auto [without_state, without_range] = range_ahead({});
  EXPECT_EQ(without_state, SectorState::blocked);  // not accepted: an obstacle like any other
  EXPECT_LT(without_range, place.x);
}

// Along the side of a ball a line of sight runs over many pixels of its rim, where colors mix.
TEST(FindFreeSpace, TheRimOfABallDoesNotBlock) {
  for (const MountedCamera& camera : {test::cameras()[0], test::camera_of_flat_pixels()}) {
    SCOPED_TRACE(camera.model().height);
    World world;
    world.wall_x = 3;
    Surface surface = Known(camera, world).surface;
    const test::KnownBall known{{1.2, 0, .1}};
    for (int r = 0; r < surface.height; ++r)
      for (int c = 0; c < surface.width; ++c)
        for (const int beside : {-1, 0, 1})
          if (known.shows_at(camera, {double(c + beside), double(r)}))
            surface.kinds[static_cast<std::size_t>(r * surface.width + c)] = SurfaceKind::object;
    surface.update_tiles();
    const Ball ball = known.seen(camera);
    const FreeSpace space = find_free_space(SectorMap(camera, {}), surface, std::span(&ball, 1));
    for (std::size_t i = 0; i < space.states.size(); ++i)
      EXPECT_TRUE(space.states[i] != SectorState::blocked || space.ranges[i] > 2) << i << ": " << space.ranges[i];
  }
}

TEST(FindFreeSpace, TurningTheMountByWholeSectorsTurnsTheArcAlone) {
  const double sector_deg = 2;
  for (const MountedCamera& camera : test::cameras())
    for (const int sectors : {45, 89, 90, -80}) {
      SCOPED_TRACE(testing::Message() << camera.model().width << " px, turned by " << sectors << " sectors");
      World world;
      world.wall_x = 3;
      const Known known(camera, world);
      const double angle = radians(sectors * sector_deg);
      const FreeSpace ahead = find_free_space(SectorMap(camera, {.sector_deg = sector_deg}), known.surface, {});
      const FreeSpace aside =
          find_free_space(SectorMap(test::turned(camera, angle), {.sector_deg = sector_deg}), known.surface, {});
      EXPECT_GE(aside.angle_min, -std::numbers::pi - 1e-9);
      EXPECT_LE(aside.angle_min, std::numbers::pi);
      EXPECT_NEAR(std::remainder(aside.angle_min - ahead.angle_min - angle, 2 * std::numbers::pi), 0, 1e-9);
      ASSERT_EQ(aside.states, ahead.states);
      for (std::size_t i = 0; i < ahead.ranges.size(); ++i) EXPECT_NEAR(aside.ranges[i], ahead.ranges[i], 0.01);
    }
}

TEST(FindFreeSpace, WithoutFloorInViewThereAreNoSectors) {
  CameraModel model = test::cameras()[1].model();
  // Looks up: no floor at all.
  const MountedCamera up(model, {.x = 0, .y = 0, .z = 0.5, .roll = 0, .pitch = -1.2, .yaw = 0});
  const SectorMap map(up, {});
  const Known known(up, World{});
  const FreeSpace space = find_free_space(map, known.surface, {});
  EXPECT_TRUE(space.states.empty());
  EXPECT_TRUE(space.ranges.empty());
  EXPECT_EQ(space.angle_min, 0);
}

TEST(FindFreeSpace, FloorUpToTheMaximalRangeIsFree) {
  const MountedCamera camera = test::cameras()[0];
  World world;
  world.wall_x = 1e6;
  const Known known(camera, world);
  const SectorMap map(camera, {.sector_deg = 5, .rays = 3, .max_range = 3, .noise_px = 2});
  const FreeSpace space = find_free_space(map, known.surface, {});
  const auto ahead = static_cast<std::size_t>(std::lround(-space.angle_min / space.angle_increment));
  EXPECT_EQ(space.states[ahead], SectorState::free);
  EXPECT_EQ(space.ranges[ahead], 3);
}

TEST(FreeSpaceOptions, RefusesWhatIsOutOfRange) {
  EXPECT_THROW(SectorMap(test::cameras()[0], {.sector_deg = 0}), Error);
}

}  // namespace
}  // namespace tassilo
