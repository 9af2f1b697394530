#include "tassilo/surface/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <utility>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/camera/test_world.h"

namespace tassilo {
namespace {

using test::Paint;

/// Regions of a rendered world by its exact paints.
struct Painted {
  explicit Painted(const MountedCamera& camera, const test::World& world)
      : frame(test::render(camera, world)), ground(camera) {
    const int width = frame.view.width(), height = frame.view.height();
    const auto where = [&](auto holds) {
      RunVector runs;
      for (int r = 0; r < height; ++r)
        for (int c = 0; c < width; ++c)
          if (holds(c, r))
            runs.push_back(
                {static_cast<std::int16_t>(r), static_cast<std::int16_t>(c), static_cast<std::int16_t>(c + 1)});
      return Region::from_runs(std::move(runs));
    };
    carpet = where([&](int c, int r) { return std::abs(frame.view.v(c, r) - test::kCarpet.v) < 8; });
    white = where([&](int c, int r) { return frame.view.y(c, r) > 160; });
    black = where([&](int c, int r) { return frame.view.y(c, r) < 60; });
  }
  Surface surface(bool calibrated = true) const {
    const std::array<const Region*, 1> colored{&black};
    return find_surface({.width = frame.view.width(),
                         .height = frame.view.height(),
                         .carpet = &carpet,
                         .white = &white,
                         .colored = colored},
                        calibrated ? &ground : nullptr);
  }
  Frame frame;
  GroundMap ground;
  Region carpet, white, black;
};

TEST(FindSurface, LinesAreFloorAndWallsAreNot) {
  for (const MountedCamera& camera : test::cameras()) {
    SCOPED_TRACE(camera.model().width);
    test::World world;
    world.wall_x = 3;
    world.lines = {{{1.2, -2}, {1.2, 2}}, {{0.8, 0.1}, {2.6, 0.3}}};  // one across the other
    const Painted painted(camera, world);
    for (const bool calibrated : {true, false}) {
      const Surface surface = painted.surface(calibrated);
      // Away from every rim by more than a pixel, each floor point is floor and each wall point is wall.
      for (double y = -0.9; y <= 0.9; y += 0.05) {
        for (double x = 0.9; x <= 2.8; x += 0.02) {
          const auto pixel = camera.project({x, y, 0});
          const int c = static_cast<int>(std::lround(pixel->x)), r = static_cast<int>(std::lround(pixel->y));
          if (c < 0 || r < 0 || c >= surface.width || r >= surface.height) continue;
          EXPECT_TRUE(surface.is_floor(c, r)) << "floor at " << x << ", " << y << (calibrated ? "" : " uncalibrated");
        }
        const auto pixel = camera.project({3, y, 0.25});
        const int c = static_cast<int>(std::lround(pixel->x)), r = static_cast<int>(std::lround(pixel->y));
        if (c < 0 || r < 0 || c >= surface.width || r >= surface.height) continue;
        EXPECT_EQ(surface.at(c, r), SurfaceKind::wall) << "wall at " << y;
      }
    }
  }
}

TEST(FindSurface, NarrowThingsOfAnotherColorAreNoFloor) {
  const MountedCamera camera = test::cameras()[1];
  test::World world;
  world.robots.push_back({.foot = {2, 0}, .radius = 0.02, .height = 0.3, .band = 1});  // a thin black pole
  const Painted painted(camera, world);
  const Surface surface = painted.surface();
  const auto foot = camera.project({1.98, 0, 0.1});
  EXPECT_FALSE(surface.is_floor(static_cast<int>(std::lround(foot->x)), static_cast<int>(std::lround(foot->y))));
}

TEST(FindSurface, AnEmptyImageHasNoPixels) {
  const Region none;
  EXPECT_TRUE(
      find_surface({.width = 0, .height = 0, .carpet = &none, .white = &none, .colored = {}}, nullptr).kinds.empty());
}

TEST(SurfaceOptions, RefusesWhatIsOutOfRange) {
  SurfaceOptions options;
  options.line_width = 0;
  EXPECT_THROW(options.check(), Error);
}

TEST(SurfaceTiles, WalksOverTilesEqualThoseOverPixels) {
  std::mt19937 random(1);
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(8, 8), std::pair(7, 20), std::pair(41, 25)})
    for (const int odd : {0, 3, 60, 100})  // percent
      for (const SurfaceKind most : {SurfaceKind::carpet, SurfaceKind::line, SurfaceKind::wall}) {
        SCOPED_TRACE(testing::Message() << width << " x " << height << ", " << odd << " % odd");
        Surface surface;
        surface.width = width;
        surface.height = height;
        for (int i = 0; i < width * height; ++i)
          surface.kinds.push_back(static_cast<int>(random() % 100) < odd ? static_cast<SurfaceKind>(random() % 5)
                                                                         : most);
        surface.update_tiles();
        for (int r = 0; r < height; ++r)
          for (int c = 0; c < width; ++c) {
            const int tile = surface.tile_row(r / Surface::kTile)[static_cast<std::size_t>(c / Surface::kTile)];
            if ((tile & Surface::all_floor) != 0) {
              EXPECT_TRUE(surface.is_floor(c, r));
            }
            if ((tile & Surface::some_floor) == 0) {
              EXPECT_FALSE(surface.is_floor(c, r));
            }
            if ((tile & Surface::some_line) == 0) {
              EXPECT_NE(surface.at(c, r), SurfaceKind::line);
            }
          }
        std::vector<std::array<int, 3>> runs, plain_runs;
        for_each_line_run(surface, [&](int r, int begin, int end) { runs.push_back({r, begin, end}); });
        std::vector<std::array<int, 2>> ends, plain_ends;
        for_each_floor_end(surface, [&](int c, int r) { ends.push_back({r, c}); });
        for (int r = 0; r < height; ++r)
          for (int c = 0; c < width; ++c) {
            const auto is_line = [&](int column) {
              return column >= 0 && column < width && surface.at(column, r) == SurfaceKind::line;
            };
            if (is_line(c) && !is_line(c - 1)) {
              int end = c;
              while (is_line(end)) ++end;
              plain_runs.push_back({r, c, end});
            }
            if (r + 1 < height && !surface.is_floor(c, r) && surface.is_floor(c, r + 1)) plain_ends.push_back({r, c});
          }
        EXPECT_EQ(runs, plain_runs);
        std::ranges::sort(ends);  // by tile first
        EXPECT_EQ(ends, plain_ends);
      }
}

}  // namespace
}  // namespace tassilo
