#include "tassilo/surface/surface.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace tassilo
