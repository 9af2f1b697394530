#include "tassilo/calibrate/intrinsics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <random>

#include "tassilo/base/error.h"
#include "tassilo/calibrate/internal/lens.h"
#include "tassilo/calibrate/test_targets.h"

namespace tassilo {
namespace {

using testing::Contains;
using testing::HasSubstr;

CameraModel camera_of(LensModel model) {
  CameraModel camera{.name = {}, .width = 640, .height = 480, .fx = 400, .fy = 380, .cx = 325, .cy = 236};
  switch (model) {
    case LensModel::division:
      camera.distortion = Division{-.18};
      break;
    case LensModel::plumb_bob:
      camera.distortion = PlumbBob{-.26, .08, .0007, -.0009, -.01};
      break;
    case LensModel::equidistant:
      camera.fx = 300;
      camera.fy = 290;
      camera.distortion = Equidistant{-.02, .01, -.004, .0006};
  }
  return camera;
}

constexpr std::array kModels{LensModel::division, LensModel::plumb_bob, LensModel::equidistant};

/// All over the image, tilted differently.
std::vector<TargetView> views_of(const CameraModel& camera, const Target& target, int count, unsigned seed,
                                 double sigma, double most_tilt = .6) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<TargetView> views;
  while (static_cast<int>(views.size()) < count) {
    const PixelPoint place{camera.width * (.5 + .42 * unit(random)), camera.height * (.5 + .42 * unit(random))};
    const Eigen::Vector3d turns(most_tilt * unit(random), most_tilt * unit(random), 3 * unit(random));
    const TargetPose pose = pose_at(camera, target, place, .45 + .1 * unit(random), turns);
    if (!(pose.rotation.col(2).dot(pose.translation.normalized()) > .3)) continue;  // its back, or nearly from the side
    TargetView view = view_of(camera, target, pose, random, sigma);
    if (view.points.size() >= 30) views.push_back(std::move(view));
  }
  return views;
}

std::vector<double> parameters_of(const CameraModel& camera) {
  std::vector<double> p{camera.fx, camera.fy, camera.cx, camera.cy};
  if (const auto* d = std::get_if<Division>(&camera.distortion)) p.push_back(d->k);
  if (const auto* d = std::get_if<PlumbBob>(&camera.distortion)) p.insert(p.end(), {d->k1, d->k2, d->p1, d->p2, d->k3});
  if (const auto* d = std::get_if<Equidistant>(&camera.distortion)) p.insert(p.end(), {d->k1, d->k2, d->k3, d->k4});
  return p;
}

TEST(Lens, IsThatOfTheCameraModel) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const LensModel model : kModels) {
    const CameraModel camera = camera_of(model);
    const auto parameters = parameters_of(camera);
    EXPECT_EQ(camera_from({640, 480}, model, parameters), camera);
    for (int i = 0; i < 200; ++i) {
      const double point[3] = {unit(random), unit(random), 1.2};
      double out[2];
      const auto shown = project(camera, {point[0], point[1], point[2]});
      ASSERT_TRUE(shown);
      ASSERT_TRUE(with_lens(
          model, [&](auto lens) { return decltype(lens)::distort(parameters.data() + kPinholeCount, point, out); }));
      EXPECT_NEAR(camera.fx * out[0] + camera.cx, shown->x, 1e-9);
      EXPECT_NEAR(camera.fy * out[1] + camera.cy, shown->y, 1e-9);
    }
  }
}

TEST(Intrinsics, PerfectPointsGiveTheCameraBack) {
  for (const LensModel model : kModels)
    for (const Target& target : {kDots, kChecker}) {
      SCOPED_TRACE(std::string(to_string(model)) + " " + to_text(target));
      const CameraModel camera = camera_of(model);
      const Intrinsics result =
          calibrate_intrinsics({640, 480}, views_of(camera, target, 12, 1, 0), {.model = model, .folds = 0});
      const auto truth = parameters_of(camera);
      ASSERT_EQ(result.values.size(), truth.size());
      // The centroids of circles are computed up to the fourth order of their size.
      for (std::size_t i = 0; i < truth.size(); ++i)
        EXPECT_NEAR(result.values[i].value, truth[i], i < 4 ? .02 : 1e-3) << result.values[i].name;
      EXPECT_LT(result.rms_px, target.kind == TargetKind::dots ? .002 : 1e-6);
      for (const ViewResult& view : result.views) EXPECT_EQ(view.rejected, "");
    }
}

/// Squared errors in units of the covariance have the mean of a chi-squared variable, when the latter is honest.
TEST(Intrinsics, StandardDeviationsAreHonest) {
  constexpr int trials = 12;
  for (const LensModel model : kModels) {
    SCOPED_TRACE(to_string(model));
    const CameraModel camera = camera_of(model);
    const auto truth = parameters_of(camera);
    const auto n = static_cast<Eigen::Index>(truth.size());
    double sum = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const auto views = views_of(camera, kChecker, 10, 100 + static_cast<unsigned>(trial), .1);
      const Intrinsics result = calibrate_intrinsics({640, 480}, views, {.model = model, .folds = 0});
      Eigen::VectorXd off(n);
      for (Eigen::Index i = 0; i < n; ++i)
        off[i] = result.values[static_cast<std::size_t>(i)].value - truth[static_cast<std::size_t>(i)];
      sum += off.dot(result.covariance.ldlt().solve(off));
      EXPECT_NEAR(result.rms_px, .1 * std::sqrt(2.), .02);
    }
    const double mean = sum / trials, expected = static_cast<double>(n);
    // Five standard deviations of the mean.
    const double spread = 5 * std::sqrt(2 * expected / trials);
    EXPECT_GT(mean, expected - spread);
    EXPECT_LT(mean, expected + spread);
  }
}

TEST(Intrinsics, BothKindsOfTargetsTogether) {
  const CameraModel camera = camera_of(LensModel::plumb_bob);
  auto views = views_of(camera, kDots, 6, 5, .03);
  const auto boards = views_of(camera, kChecker, 6, 6, .2);
  views.insert(views.end(), boards.begin(), boards.end());
  const Intrinsics result = calibrate_intrinsics({640, 480}, views, {.model = LensModel::plumb_bob});
  const auto truth = parameters_of(camera);
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_LT(std::abs(result.values[i].value - truth[i]), 4 * result.values[i].sigma) << result.values[i].name;
  ASSERT_TRUE(result.cross_validated_rms_px);
  EXPECT_NEAR(*result.cross_validated_rms_px, result.rms_px, .05);
}

TEST(Intrinsics, AWrongViewIsThrownOut) {
  const CameraModel camera = camera_of(LensModel::division);
  auto views = views_of(camera, kChecker, 9, 8, .05);
  for (SeenPoint& point : views[4].points) point.pixel.x += 4 * std::sin(point.row);  // crumpled
  views[6].points[5].pixel.x += 5;                                                    // one wrong point
  views[7].points.resize(8);
  const Intrinsics result = calibrate_intrinsics({640, 480}, views, {.model = LensModel::division});
  EXPECT_THAT(result.views[4].rejected, HasSubstr("px off"));
  EXPECT_THAT(result.views[7].rejected, HasSubstr("8 points"));
  EXPECT_EQ(result.views[6].rejected, "");
  EXPECT_FALSE(result.views[6].points[5].used);
  for (const std::size_t v : {0, 1, 2, 3, 5, 6, 8}) EXPECT_EQ(result.views[v].rejected, "") << v;
  EXPECT_NEAR(result.camera.fx, camera.fx, .005 * camera.fx);
}

TEST(Intrinsics, CoefficientsNotAskedForStayZero) {
  CameraModel camera = camera_of(LensModel::plumb_bob);
  camera.distortion = PlumbBob{-.2, .03, 0, 0, 0};
  const auto views = views_of(camera, kChecker, 10, 9, .05);
  const Intrinsics result =
      calibrate_intrinsics({640, 480}, views, {.model = LensModel::plumb_bob, .radial_terms = 2, .tangential = false});
  const auto& lens = std::get<PlumbBob>(result.camera.distortion);
  EXPECT_EQ(lens.k3, 0);
  EXPECT_EQ(lens.p1, 0);
  EXPECT_EQ(lens.p2, 0);
  EXPECT_NEAR(lens.k1, -.2, .01);
  EXPECT_EQ(result.values.back().sigma, 0);
}

TEST(Intrinsics, WarnsOfWhatIsDoubtful) {
  const CameraModel camera = camera_of(LensModel::division);
  const auto few = calibrate_intrinsics({640, 480}, views_of(camera, kChecker, 4, 10, .05));
  EXPECT_THAT(few.warnings, Contains(HasSubstr("only 4 views")));
  std::mt19937 random(11);
  std::vector<TargetView> corner;
  for (int i = 0; i < 8; ++i)
    corner.push_back(view_of(
        camera, kChecker, pose_at(camera, kChecker, {200, 150}, .8, {.1 * i - .4, .3 - .1 * i, .2 * i}), random, .05));
  EXPECT_THAT(calibrate_intrinsics({640, 480}, corner).warnings, Contains(HasSubstr("of the image, should be")));
  EXPECT_THAT(calibrate_intrinsics({640, 480}, views_of(camera, kChecker, 8, 12, .05, .1)).warnings,
              Contains(HasSubstr("tilted by at most")));
  EXPECT_THAT(calibrate_intrinsics({640, 480}, views_of(camera, kChecker, 20, 13, .05)).warnings, testing::IsEmpty());
}

/// Views of dots whose frames show, none of which reaches the image's corners.
std::vector<TargetView> inner_views(const CameraModel& camera, std::mt19937& random, double sigma,
                                    double frame_distance = 1.125) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<TargetView> views;
  while (views.size() < 8) {
    const PixelPoint place{camera.width * (.5 + .25 * unit(random)), camera.height * (.4 + .2 * unit(random))};
    const Eigen::Vector3d turns(.6 * unit(random), .6 * unit(random), 3 * unit(random));
    const TargetPose pose = pose_at(camera, kDots, place, .55 + .1 * unit(random), turns);
    if (!(pose.rotation.col(2).dot(pose.translation.normalized()) > .4)) continue;
    TargetView view = view_of(camera, kDots, pose, random, sigma);
    if (view.points.size() < 40) continue;
    view.frame = frame_of(camera, kDots, pose, random, .8 * sigma, frame_distance);
    views.push_back(std::move(view));
  }
  return views;
}

TEST(Intrinsics, FramesOfDotsReachFartherThanTheDots) {
  for (const LensModel model : {LensModel::division, LensModel::plumb_bob}) {
    SCOPED_TRACE(to_string(model));
    const CameraModel camera = camera_of(model);
    const auto truth = parameters_of(camera);
    double with = 0, without = 0, in_sigmas = 0;
    constexpr int trials = 3;
    for (unsigned trial = 0; trial < trials; ++trial) {
      std::mt19937 random(40 + trial);
      const auto views = inner_views(camera, random, .02);
      const Intrinsics framed = calibrate_intrinsics({640, 480}, views, {.model = model, .folds = 0});
      const Intrinsics bare = calibrate_intrinsics({640, 480}, views, {.model = model, .frames = false, .folds = 0});
      EXPECT_EQ(framed.frames_rejected, "");
      EXPECT_GT(framed.frame_places, 500);
      EXPECT_EQ(bare.frame_places, 0);
      EXPECT_LT(framed.worst_sigma_px, bare.worst_sigma_px);
      with += mapped_error(camera, framed.camera).worst;
      without += mapped_error(camera, bare.camera).worst;
      Eigen::VectorXd off(static_cast<Eigen::Index>(truth.size()));
      for (std::size_t i = 0; i < truth.size(); ++i)
        off[static_cast<Eigen::Index>(i)] = framed.values[i].value - truth[i];
      in_sigmas += off.dot(framed.covariance.ldlt().solve(off));
    }
    EXPECT_LT(with, .7 * without);
    const auto n = static_cast<double>(truth.size());
    EXPECT_NEAR(in_sigmas / trials, n, 5 * std::sqrt(2 * n / trials));
  }
}

TEST(Intrinsics, WhereAFrameIsDoesNotMatter) {
  const CameraModel camera = camera_of(LensModel::division);
  std::array<double, 2> worst{};
  for (const std::size_t far : {0U, 1U}) {
    std::mt19937 random(50);
    const Intrinsics result =
        calibrate_intrinsics({640, 480}, inner_views(camera, random, .02, far == 1 ? 1.3 : 1.125));
    EXPECT_EQ(result.frames_rejected, "");
    EXPECT_GT(result.frame_places, 500);
    worst[far] = mapped_error(camera, result.camera).worst;
  }
  EXPECT_NEAR(worst[0], worst[1], .1);
}

TEST(Intrinsics, FramesThatAreBentAreLeftOut) {
  const CameraModel camera = camera_of(LensModel::division);
  std::mt19937 random(60);
  auto views = inner_views(camera, random, .02);
  for (TargetView& view : views)
    for (FramePlace& place : view.frame) {
      const double bow = .08 * (place.along - 3) * (place.along - 3);  // up to 1 px
      place.pixel = place.pixel + bow * place.normal;
    }
  const Intrinsics framed = calibrate_intrinsics({640, 480}, views);
  const Intrinsics bare = calibrate_intrinsics({640, 480}, views, {.frames = false});
  EXPECT_NE(framed.frames_rejected, "");
  EXPECT_EQ(framed.camera, bare.camera);
  EXPECT_THAT(framed.warnings, Contains(HasSubstr("frame")));
}

TEST(Intrinsics, ATargetThatLeavesTheImageCoversItsCorners) {
  for (const LensModel model : {LensModel::division, LensModel::plumb_bob}) {
    SCOPED_TRACE(to_string(model));
    const CameraModel camera = camera_of(model);
    std::mt19937 random(80);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<TargetView> views;
    while (views.size() < 8) {
      const PixelPoint place{camera.width * (.5 + .4 * unit(random)), camera.height * (.5 + .4 * unit(random))};
      const TargetPose pose =
          pose_at(camera, kTags, place, .3, {.5 * unit(random), .5 * unit(random), 3 * unit(random)});
      if (!(pose.rotation.col(2).dot(pose.translation.normalized()) > .4)) continue;
      TargetView view = view_of(camera, kTags, pose, random, .04);
      if (view.points.size() >= 12) views.push_back(std::move(view));
    }
    const Intrinsics result = calibrate_intrinsics({640, 480}, views, {.model = model, .folds = 0});
    EXPECT_GT(result.coverage.reach, .9);
    EXPECT_LT(mapped_error(camera, result.camera).worst, .3);
  }
}

TEST(Intrinsics, FewerThanThreeViewsAreRefused) {
  const CameraModel camera = camera_of(LensModel::division);
  EXPECT_THROW(calibrate_intrinsics({640, 480}, {}), Error);
  EXPECT_THROW(calibrate_intrinsics({640, 480}, views_of(camera, kDots, 2, 14, .05)), Error);
}

TEST(IntrinsicsOptions, BadOnesAreNamed) {
  EXPECT_THROW((IntrinsicsOptions{.radial_terms = 2}).check(), Error);
  EXPECT_THROW((IntrinsicsOptions{.outlier_ratio = 1}).check(), Error);
  EXPECT_THROW((IntrinsicsOptions{.folds = 1}).check(), Error);
  EXPECT_NO_THROW((IntrinsicsOptions{.model = LensModel::equidistant, .radial_terms = 4, .folds = 0}).check());
}

}  // namespace
}  // namespace tassilo
