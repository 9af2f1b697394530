#include "tassilo/calibrate/mount_from_target.h"
#include "tassilo/calibrate/find_target.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tassilo/base/error.h"
#include "tassilo/calibrate/test_targets.h"
#include "tassilo/geometry/angle.h"

namespace tassilo {
namespace {

// The cameras of the recordings msl98, and one of each other lens.
const CameraModel kDiv{"div", 384, 172, 216, 177.631578947, 187.3, 88.9, Division{-.1458}};
const CameraModel kVga{"vga", 640, 480, 392, 390.5, 316.8, 246.2, PlumbBob{-.262, .078, .0006, -.0009, -.008}};
const CameraModel kWide{"wide", 640, 480, 300, 300, 320, 240, Equidistant{.01, -.002, 0, 0}};
const CameraModel kRational{"rational", 640,   480,   392,
                            390.5,      316.8, 246.2, RationalPolynomial{-.05, .01, 0, 0, 0, .08, 0, 0}};
const CameraMount kMount{.06, .015, .52, .007, .44, -.014};
const Target kBoard{TargetKind::dots, 7, 7, .08, .02}, kCheckerBoard{TargetKind::checkerboard, 9, 6, .06, 0};

/// A target whose middle lies `distance` ahead, seen from behind its last row, or turned.
TargetPlace place_ahead(const Target& target, double distance, double yaw, double height = 0) {
  TargetPlace place{0, 0, yaw, height};
  const TargetPose lying = robot_from_target(place);
  const Eigen::Vector3d middle = lying.rotation * Eigen::Vector3d((target.columns - 1) * target.pitch / 2,
                                                                  (target.rows - 1) * target.pitch / 2, 0);
  place.x = distance - middle.x();
  place.y = -middle.y();
  return place;
}

double in_sigmas(double found, double truth, double sigma) { return std::abs(found - truth) / sigma; }

TEST(TargetPlace, FaceUp) {
  const TargetPose pose = robot_from_target({1, 2, radians(90), .01});
  // Columns run to the left of the robot, rows away from it: what looks up has z down.
  EXPECT_NEAR((pose.rotation * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0, 1, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((pose.rotation * Eigen::Vector3d(0, 1, 0) - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(pose.rotation.determinant(), 1, 1e-12);
  EXPECT_EQ(pose.translation, Eigen::Vector3d(1, 2, .01));
}

TEST(MountFromTarget, ExactPointsGiveTheMountForEveryLens) {
  for (const CameraModel& camera : {kDiv, kVga, kWide, kRational})
    for (const Target& target : {kBoard, kCheckerBoard})
      for (const double yaw : {-90., 0., 37., 180.}) {
        SCOPED_TRACE(camera.name + " " + to_text(target) + " " + std::to_string(yaw));
        const std::vector<TargetPlace> places{place_ahead(target, 1.1, radians(yaw), .005)};
        std::mt19937 random(1);
        const PlacedView view{view_of(camera, target, seen_by({camera, kMount}, places[0]), random, 0), 0};
        const MountFromTarget result = mount_from_target(camera, places, std::vector{view});
        const CameraMount& found = result.estimate.mount;
        EXPECT_NEAR(found.x, kMount.x, 1e-4);
        EXPECT_NEAR(found.y, kMount.y, 1e-4);
        EXPECT_NEAR(found.z, kMount.z, 1e-4);
        EXPECT_NEAR(found.roll, kMount.roll, 1e-4);
        EXPECT_NEAR(found.pitch, kMount.pitch, 1e-4);
        EXPECT_NEAR(found.yaw, kMount.yaw, 1e-4);
        EXPECT_LT(result.rms_px, 5e-3);
        EXPECT_EQ(result.views.size(), 1U);
      }
}

// Points with noise, targets a little beside where they were told: the squares of errors over sigmas are what they
// should be on average, and none is beyond any doubt.
TEST(MountFromTarget, SigmasAreTrue) {
  constexpr int draws = 60;
  const MountFromTargetOptions options;
  double squares[6]{};
  for (int draw = 0; draw < draws; ++draw) {
    SCOPED_TRACE(draw);
    std::mt19937 random(static_cast<unsigned>(draw));
    std::normal_distribution<double> gauss;
    std::vector<TargetPlace> places;
    std::vector<PlacedView> views;
    for (const double yaw : {-80., 25.}) {
      const TargetPlace told = place_ahead(kBoard, 1.2, radians(yaw));
      TargetPlace truth = told;
      truth.x += options.place_sigma * gauss(random);
      truth.y += options.place_sigma * gauss(random);
      truth.yaw += options.place_yaw_sigma * gauss(random);
      truth.height += options.place_height_sigma * gauss(random);
      views.push_back({view_of(kVga, kBoard, seen_by({kVga, kMount}, truth), random, .1), places.size()});
      places.push_back(told);
    }
    const EstimatedMount found = mount_from_target(kVga, places, views).estimate;
    const double off[]{in_sigmas(found.mount.x, kMount.x, found.sigma.x),
                       in_sigmas(found.mount.y, kMount.y, found.sigma.y),
                       in_sigmas(found.mount.z, kMount.z, found.sigma.z),
                       in_sigmas(found.mount.roll, kMount.roll, found.sigma.roll),
                       in_sigmas(found.mount.pitch, kMount.pitch, found.sigma.pitch),
                       in_sigmas(found.mount.yaw, kMount.yaw, found.sigma.yaw)};
    for (int i = 0; i < 6; ++i) {
      squares[i] += off[i] * off[i] / draws;
      EXPECT_LT(off[i], 4);
    }
  }
  for (const double square : squares) {
    EXPECT_GT(square, .5);
    EXPECT_LT(square, 1.7);
  }
}

// What people do: images of a board on the floor, through detector and lens.
TEST(MountFromTarget, RenderedViewsWithinThreeSigmas) {
  for (const auto& [camera, target] :
       {std::pair(kVga, kBoard), std::pair(kVga, kCheckerBoard), std::pair(kWide, kBoard)})
    for (const double yaw : {-90., -60.}) {
      SCOPED_TRACE(camera.name + " " + to_text(target) + " " + std::to_string(yaw));
      const std::vector<TargetPlace> places{place_ahead(target, 1, radians(yaw))};
      const TestImage image = render(camera, target, seen_by({camera, kMount}, places[0]), 3);
      const TargetSearch search = find_target(image.view(), target);
      ASSERT_TRUE(search.view) << search.reason;
      const MountFromTarget result = mount_from_target(camera, places, std::vector<PlacedView>{{*search.view, 0}});
      const auto& [mount, sigma, covariance] = result.estimate;
      EXPECT_LT(in_sigmas(mount.z, kMount.z, sigma.z), 3);
      EXPECT_LT(in_sigmas(mount.roll, kMount.roll, sigma.roll), 3);
      EXPECT_LT(in_sigmas(mount.pitch, kMount.pitch, sigma.pitch), 3);
      EXPECT_LT(in_sigmas(mount.yaw, kMount.yaw, sigma.yaw), 3);
      EXPECT_LT(std::abs(mount.pitch - kMount.pitch), radians(.1));
      EXPECT_LT(std::abs(mount.z - kMount.z), .005);
    }
}

TEST(MountFromTarget, APointThatIsWrongIsThrownOut) {
  const std::vector<TargetPlace> places{place_ahead(kBoard, 1.1, 0)};
  std::mt19937 random(5);
  PlacedView view{view_of(kVga, kBoard, seen_by({kVga, kMount}, places[0]), random, .05), 0};
  view.view.points[10].pixel.x += 4;
  const MountFromTarget result = mount_from_target(kVga, places, std::vector{view});
  EXPECT_FALSE(result.views[0].points[10].used);
  EXPECT_TRUE(result.views[0].points[11].used);
  EXPECT_NEAR(result.estimate.mount.pitch, kMount.pitch, 1e-3);
}

TEST(MountFromTarget, AnotherPlaceIsTold) {
  std::vector<TargetPlace> places{place_ahead(kBoard, 1, 0), place_ahead(kBoard, 1.4, 1)};
  std::mt19937 random(6);
  std::vector<PlacedView> views;
  for (std::size_t p = 0; p < places.size(); ++p)
    views.push_back({view_of(kVga, kBoard, seen_by({kVga, kMount}, places[p]), random, .05), p});
  EXPECT_TRUE(mount_from_target(kVga, places, views).warnings.empty());
  places[1].x += .03;
  EXPECT_FALSE(mount_from_target(kVga, places, views).warnings.empty());
}

TEST(MountFromTarget, RefusesWhatDeterminesNothing) {
  const std::vector<TargetPlace> places{place_ahead(kBoard, 1, 0)};
  std::mt19937 random(7);
  const PlacedView good{view_of(kVga, kBoard, seen_by({kVga, kMount}, places[0]), random, .05), 0};
  EXPECT_THROW(mount_from_target(kVga, places, {}), Error);
  PlacedView few = good;
  few.view.points.resize(11);
  EXPECT_THROW(mount_from_target(kVga, places, std::vector{few}), Error);
  PlacedView line{{{TargetKind::dots, 20, 7, .02, .005}, {}}, 0};
  for (int c = 0; c < 20; ++c) line.view.points.push_back({c, 0, {100. + c, 200}});
  EXPECT_THROW(mount_from_target(kVga, places, std::vector{line}), Error);
  // From behind: the camera would be in the floor.
  PlacedView behind = good;
  for (SeenPoint& point : behind.view.points) point.column = kBoard.columns - 1 - point.column;
  EXPECT_THROW(mount_from_target(kVga, places, std::vector{behind}), Error);
  // Another lens than told.
  CameraModel other = kVga;
  other.distortion = PlumbBob{};
  const TargetPlace near = place_ahead(kBoard, .75, 0);
  const PlacedView bent{view_of(other, kBoard, seen_by({other, kMount}, near), random, 0), 0};
  EXPECT_THROW(mount_from_target(kVga, std::vector{near}, std::vector{bent}), Error);
  EXPECT_THROW(mount_from_target(kVga, std::vector<TargetPlace>{{1, 0, 0, -.1}}, std::vector{good}), Error);
  EXPECT_THROW(mount_from_target(kVga, std::vector<TargetPlace>{{1100, 0, 0, 0}}, std::vector{good}), Error);
}

}  // namespace
}  // namespace tassilo
