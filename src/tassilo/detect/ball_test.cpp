#include "tassilo/detect/ball.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/detect/sphere_fit.h"
#include "tassilo/detect/test_view.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

using test::Seen;
using test::World;

World ball_at(FloorPoint foot, double radius) {
  World world;
  world.spheres.push_back({{foot.x, foot.y, radius}, radius});
  return world;
}

/// Places each test camera sees well.
const FloorPoint kPlaces[] = {{0.9, 0.1}, {1.5, -0.4}, {2.5, 0.6}, {3.8, -0.9}};

TEST(FindBalls, PlacesTheBallForEveryLensAndRadius) {
  for (const MountedCamera& camera : test::cameras())
    for (const FloorPoint place : kPlaces)
      for (const double radius : {0.1, 0.105, 0.11}) {
        SCOPED_TRACE(testing::Message() << camera.model().width << " px, " << place.x << ", " << place.y << ", radius "
                                        << radius);
        const Seen seen(camera, ball_at(place, radius));
        const auto balls = find_balls(seen.view());
        ASSERT_EQ(balls.size(), 1u);
        const BallOnFloor& floor = balls[0].floor.value();
        EXPECT_LT(distance(floor.position.mean, place), 0.02 * norm(place));
        EXPECT_LE(floor.bounds.near, norm(place));
        EXPECT_GE(floor.bounds.far, norm(place));
        EXPECT_LT(floor.bounds.far - floor.bounds.near, 0.15 * norm(place));
        const auto center = camera.project({place.x, place.y, radius});
        EXPECT_LT(distance(balls[0].center, center.value()), 0.5);
        EXPECT_GT(balls[0].confidence, 0.5);
        const Eigen::Matrix2d& covariance = floor.position.covariance;
        EXPECT_GT(covariance.determinant(), 0);
        const Eigen::Vector2d error(floor.position.mean.x - place.x, floor.position.mean.y - place.y);
        EXPECT_LT(error.dot(covariance.ldlt().solve(error)), 25);
      }
}

TEST(FindBalls, PartlyHiddenByARobotItStaysWhereItIs) {
  const MountedCamera camera = test::cameras()[1];
  World world = ball_at({2.2, 0.0}, 0.105);
  world.robots.push_back({.foot = {1.5, -0.24}, .radius = 0.2});
  const Seen seen(camera, world);
  const auto balls = find_balls(seen.view());
  ASSERT_EQ(balls.size(), 1u);
  EXPECT_LT(distance(balls[0].floor->position.mean, {2.2, 0.0}), 0.06 * 2.2);
}

TEST(FindBalls, BeforeARobotAndOnALineItIsStillTheBall) {
  const MountedCamera camera = test::cameras()[0];
  World world = ball_at({1.8, 0.2}, 0.105);
  world.robots.push_back({.foot = {2.3, 0.25}, .radius = 0.22, .marker = test::kMagenta});
  world.lines.push_back({{1.75, -2}, {1.75, 2}});
  const Seen seen(camera, world);
  const auto balls = find_balls(seen.view());
  ASSERT_EQ(balls.size(), 1u);
  EXPECT_LT(distance(balls[0].floor->position.mean, {1.8, 0.2}), 0.03 * 1.8);
}

// Rejected by where they would stand, not by a tuned number.
TEST(FindBalls, RejectsWhatDoesNotRestOnTheFloor) {
  for (const MountedCamera& camera : test::cameras()) {
    SCOPED_TRACE(camera.model().width);
    World floating;
    floating.spheres.push_back({{2.5, 0.3, 0.6}, 0.105});   // on top of a wall
    floating.spheres.push_back({{6.0, -1.0, 0.9}, 0.3});    // a shirt behind the wall
    floating.spheres.push_back({{2.0, -0.5, 0.25}, 0.25});  // too large
    floating.spheres.push_back({{1.2, 0.3, 0.03}, 0.03});   // too small
    const Seen seen(camera, floating);
    EXPECT_TRUE(find_balls(seen.view()).empty());
  }
}

TEST(FindBalls, WithoutCalibrationItTellsBoxAndConfidence) {
  const MountedCamera camera = test::cameras()[1];
  const Seen seen(camera, ball_at({1.5, 0.1}, 0.105), false);
  const auto balls = find_balls(seen.view());
  ASSERT_EQ(balls.size(), 1u);
  EXPECT_FALSE(balls[0].floor.has_value());
  EXPECT_GT(balls[0].confidence, 0.5);
  EXPECT_NEAR(balls[0].box.width(), balls[0].box.height(), 3);
}

TEST(FindBalls, NothingRedIsNoBall) {
  const Seen seen(test::cameras()[0], World{});
  EXPECT_TRUE(find_balls(seen.view()).empty());
}

TEST(SearchBalls, SaysWhyThereIsNone) {
  const MountedCamera camera = test::cameras()[0];
  const auto why = [&](const World& world, bool calibrated = true) {
    return std::string(search_balls(Seen(camera, world, calibrated).view()).why);
  };
  EXPECT_EQ(why(ball_at({1.8, 0.2}, 0.105)), "");
  EXPECT_EQ(why(World{}), "no red region of 4 px or more and 3 columns");
  World world;
  world.spheres.push_back({{2.5, 0.3, 0.6}, 0.105});  // before the wall, above the floor
  EXPECT_THAT(why(world), testing::MatchesRegex(
                              "the largest red region, [0-9]+ px at .[0-9]+, [0-9]+., does not stand on the floor"));
  EXPECT_THAT(why(world, false), testing::EndsWith("has no carpet below it"));
  world.spheres = {{{1.2, 0.3, 0.03}, 0.03}};
  EXPECT_THAT(why(world), testing::StartsWith("the largest red region, "));
}

TEST(FitRestingSphere, ComesBackFromItsOwnOutline) {
  for (const MountedCamera& camera : test::cameras())
    for (const FloorPoint place : kPlaces) {
      const RestingSphere truth{place, 0.104};
      std::vector<PixelPoint> edges;
      for (const OutlinePoint& p : outline(camera, truth, 40)) edges.push_back(p.at);
      ASSERT_EQ(edges.size(), 40u);
      const RestingSphere start{place + FloorPoint{0.3, -0.1}, 0.105};
      const auto fit =
          fit_resting_sphere(camera, edges, start, {.radius = {0.10, 0.11}, .edge_sigma_px = 0.1, .iterations = 30});
      ASSERT_TRUE(fit.has_value());
      // The prior pulls the radius a little; the outline holds against it.
      EXPECT_LT(distance(fit->sphere.foot, place), 0.01 * norm(place));
      EXPECT_LT(fit->rms_px, 0.05);
    }
}

TEST(FitRestingSphere, ABallStraightBelowTheEyeIsOneLikeAnyOther) {
  CameraModel model = test::cameras()[2].model();
  const MountedCamera down(model, {.x = 0.2, .y = -0.1, .z = 1.2, .roll = 0, .pitch = radians(90), .yaw = 0});
  const RestingSphere truth{{0.2, -0.1}, 0.105};
  std::vector<PixelPoint> edges;
  for (const OutlinePoint& p : outline(down, truth, 24)) edges.push_back(p.at);
  ASSERT_EQ(edges.size(), 24u);
  const auto fit =
      fit_resting_sphere(down, edges, truth, {.radius = {0.10, 0.11}, .edge_sigma_px = 0.1, .iterations = 30});
  ASSERT_TRUE(fit.has_value());
  EXPECT_LT(distance(fit->sphere.foot, truth.foot), 1e-3);
  EXPECT_LT(fit->rms_px, 0.05);
}

TEST(FindBalls, ItsBoundsHoldForAnEyeBelowItsMiddle) {
  const MountedCamera low(test::cameras()[1].model(), {.x = 0, .y = 0, .z = 0.08, .roll = 0, .pitch = 0.1, .yaw = 0});
  for (const double place : {0.45, 0.7, 1.1}) {
    SCOPED_TRACE(place);
    const Seen seen(low, ball_at({place, 0.05}, 0.105));
    const auto balls = find_balls(seen.view());
    ASSERT_EQ(balls.size(), 1u);
    const DistanceBounds bounds = balls[0].floor->bounds;
    EXPECT_LE(bounds.near, std::hypot(place, 0.05));
    EXPECT_GE(bounds.far, std::hypot(place, 0.05));
    EXPECT_LT(bounds.far - bounds.near, 0.5 * place);
  }
}

TEST(BallOptions, RefusesWhatIsOutOfRange) {
  BallOptions options;
  options.min_cover = 1.5;
  EXPECT_THROW(options.check(), Error);
}

}  // namespace
}  // namespace tassilo
