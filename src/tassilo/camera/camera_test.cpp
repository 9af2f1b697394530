#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>

#include "tassilo/base/error.h"
#include "tassilo/camera/camera_model.h"
#include "tassilo/camera/ground_map.h"
#include "tassilo/camera/mount.h"

namespace tassilo {
namespace {

// The cameras of ../shared/data/msl98, and one of each further model.
const CameraModel kDiv{"div", 384, 172, 216.0, 177.631578947, 187.3, 88.9, Division{-0.1458}};
const CameraModel kVga{"vga", 640, 480, 392.0, 390.5, 316.8, 246.2, PlumbBob{-0.262, 0.078, 0.0006, -0.0009, -0.008}};
const CameraModel kXga{"xga", 1280, 960, 805.0, 806.2, 646.3, 471.4, PlumbBob{-0.27, 0.085, -0.0004, 0.0005, -0.0095}};
const CameraModel kPincushion{"pincushion", 640, 480, 500, 490, 310, 250, PlumbBob{0.12, 0.03, 0.001, -0.002, 0.004}};
const CameraModel kDivisionPincushion{"division pincushion", 640, 480, 500, 480, 320, 240, Division{0.12}};
const CameraModel kRational{
    "rational", 1280, 720, 610, 608, 640.5, 358, RationalPolynomial{4.1, 1.9, 0.0002, -0.0003, 0.07, 4.45, 3.2, 0.45}};
const CameraModel kFisheye{"fisheye", 640, 480, 190, 188, 322, 238, Equidistant{-0.012, 0.004, -0.0011, 0.0001}};
const CameraModel kWideFisheye{"beyond 180 degrees", 1000, 800, 230, 230, 500, 400, Equidistant{0.002, -0.0005, 0, 0}};
const CameraModel kPinhole{"pinhole", 640, 480, 642.4, 642.5, 322.8, 239.8, PlumbBob{}};

const std::vector<CameraModel>& cameras() {
  static const std::vector<CameraModel> all{kDiv,      kVga,     kXga,         kPincushion, kDivisionPincushion,
                                            kRational, kFisheye, kWideFisheye, kPinhole};
  return all;
}

std::vector<PixelPoint> grid_with_corners(const CameraModel& camera) {
  std::vector<PixelPoint> out;
  constexpr int n = 24;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k) out.push_back({camera.width * i / double{n} - .5, camera.height * k / double{n} - .5});
  return out;
}

double degrees_between(OpticalPoint a, OpticalPoint b) {
  return std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

TEST(CameraModel, PixelToRayToPixel) {
  for (const CameraModel& camera : cameras()) {
    SCOPED_TRACE(camera.name);
    EXPECT_NO_THROW(camera.check());
    for (const PixelPoint pixel : grid_with_corners(camera)) {
      const auto ray = unproject(camera, pixel);
      ASSERT_TRUE(ray) << pixel.x << ", " << pixel.y;
      EXPECT_NEAR(norm(*ray), 1, 1e-15);
      const auto back = project(camera, *ray);
      ASSERT_TRUE(back) << pixel.x << ", " << pixel.y;
      EXPECT_LT(distance(*back, pixel), 1e-10) << pixel.x << ", " << pixel.y;
    }
  }
}

TEST(CameraModel, RayToPixelToRayWhereverARayShows) {
  for (const CameraModel& camera : cameras()) {
    SCOPED_TRACE(camera.name);
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    int shown = 0;
    for (int i = 0; i < 3000; ++i) {
      const OpticalPoint direction = normalized(OpticalPoint{normal(random), normal(random), normal(random)});
      const auto pixel = project(camera, direction);
      if (!pixel) continue;
      ++shown;
      const auto back = unproject(camera, *pixel);
      ASSERT_TRUE(back) << direction.x << ", " << direction.y << ", " << direction.z;
      // The lens hardly moves the pixel near a fold, and one pixel is then many directions.
      const auto near = project(camera, normalized(direction + OpticalPoint{1e-6, 1e-6, 1e-6}));
      const bool stiff = near && distance(*near, *pixel) > 1e-7;
      EXPECT_LT(degrees_between(direction, *back), stiff ? 1e-6 : 1e-3);
    }
    EXPECT_GT(shown, 100);
  }
}

TEST(CameraModel, PointsOnOneRayShowAtOnePixel) {
  for (const CameraModel& camera : cameras()) {
    SCOPED_TRACE(camera.name);
    const OpticalPoint point{.3, -.2, 1.1};
    const auto near = project(camera, point), far = project(camera, 40 * point);
    ASSERT_TRUE(near && far);
    EXPECT_LT(distance(*near, *far), 1e-10);
  }
}

TEST(CameraModel, PrincipalPointIsStraightAhead) {
  for (const CameraModel& camera : cameras()) {
    SCOPED_TRACE(camera.name);
    EXPECT_EQ(project(camera, {0, 0, 2}), (PixelPoint{camera.cx, camera.cy}));
    EXPECT_EQ(unproject(camera, {camera.cx, camera.cy}), (OpticalPoint{0, 0, 1}));
    EXPECT_FALSE(project(camera, {0, 0, -2}));
    EXPECT_FALSE(project(camera, {0, 0, 0}));
  }
}

TEST(CameraModel, FollowsTheModelsDefinitions) {
  // plumb_bob and division as written in the README of msl98.
  const double x = .31, y = -.22, q = x * x + y * y, g = 1 - .262 * q + .078 * q * q - .008 * q * q * q;
  const double xd = x * g + 2 * .0006 * x * y - .0009 * (q + 2 * x * x);
  const double yd = y * g + .0006 * (q + 2 * y * y) - 2 * .0009 * x * y;
  const auto vga = project(kVga, {x, y, 1});
  ASSERT_TRUE(vga);
  EXPECT_NEAR(vga->x, 392 * xd + 316.8, 1e-10);
  EXPECT_NEAR(vga->y, 390.5 * yd + 246.2, 1e-10);

  const auto ray = unproject(kDiv, {60, 20});
  ASSERT_TRUE(ray);
  const double u = (60 - 187.3) / 216, v = (20 - 88.9) / 177.631578947, bend = 1 - .1458 * (u * u + v * v);
  EXPECT_NEAR(ray->x / ray->z, u / bend, 1e-14);
  EXPECT_NEAR(ray->y / ray->z, v / bend, 1e-14);

  // The bare equidistant lens: the angle from the axis is the image radius over the focal length.
  const CameraModel fisheye{"", 600, 600, 180, 180, 300, 300, Equidistant{}};
  EXPECT_NEAR(project(fisheye, {1, 0, 1})->x, 300 + 180 * std::numbers::pi / 4, 1e-10);
  EXPECT_NEAR(project(fisheye, {0, 3, 0})->y, 300 + 180 * std::numbers::pi / 2, 1e-10);
}

TEST(CameraModel, FisheyeSeesBehindTheImagePlane) {
  const auto pixel = project(kWideFisheye, {1, .2, -.3});
  ASSERT_TRUE(pixel);
  EXPECT_LT(degrees_between(*unproject(kWideFisheye, *pixel), {1, .2, -.3}), 1e-9);
}

TEST(CameraModel, OthersSeeNothingSidewaysOrBehind) {
  for (const CameraModel& camera : cameras()) {
    if (std::holds_alternative<Equidistant>(camera.distortion)) continue;
    SCOPED_TRACE(camera.name);
    EXPECT_FALSE(project(camera, {1, 0, 0}));
    EXPECT_FALSE(project(camera, {1, 0, -.1}));
    const auto nearly = project(camera, {1, .5, 1e-200});
    EXPECT_TRUE(!nearly || (std::isfinite(nearly->x) && std::isfinite(nearly->y)));
  }
}

TEST(CameraModel, DivisionReachesToNinetyDegrees) {
  const auto pixel = project(kDiv, {1, 0, 1e-9});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x, 187.3 + 216 / std::sqrt(.1458), 1e-3);
  EXPECT_FALSE(unproject(kDiv, {pixel->x + 1, 88.9}));
}

// r (1 - r^2 / 3) rises up to r = 1 and then comes back: the same pixels again.
TEST(CameraModel, NothingShowsBeyondTheFold) {
  const CameraModel plumb{"", 640, 480, 300, 300, 320, 240, PlumbBob{.k1 = -1. / 3}};
  const CameraModel rational{"", 640, 480, 300, 300, 320, 240, RationalPolynomial{.k4 = 1}};  // r / (1 + r^2)
  for (const CameraModel& camera : {plumb, rational}) {
    SCOPED_TRACE(distortion_name(camera.distortion));
    EXPECT_TRUE(project(camera, {.999, 0, 1}));
    EXPECT_FALSE(project(camera, {1.001, 0, 1}));
    EXPECT_FALSE(project(camera, {1.5, 0, 1}));
    EXPECT_FALSE(project(camera, {50, 0, 1}));
    const double rim = project(camera, {1 - 1e-9, 0, 1})->x;
    const auto inside = unproject(camera, {rim - .01, 240});
    ASSERT_TRUE(inside);
    EXPECT_LT(inside->x / inside->z, 1);
    EXPECT_LT(distance(*project(camera, *inside), {rim - .01, 240}), 1e-9);
    EXPECT_FALSE(unproject(camera, {rim + .01, 240}));
    EXPECT_FALSE(unproject(camera, {rim + 300, 0}));
  }
}

// r (1 - .6 q + .15 q^2 ...) falls between two radii and rises again behind: only the first branch is the lens.
TEST(CameraModel, NothingShowsBeyondTheFirstFoldEvenWhereTheMappingRisesAgain) {
  const CameraModel camera{"", 640, 480, 300, 300, 320, 240, PlumbBob{.k1 = -.6, .k2 = .15}};
  const auto rises = [](double q) { return 1 - 1.8 * q + .75 * q * q; };
  const double first = (1.8 - std::sqrt(1.8 * 1.8 - 3)) / 1.5;
  ASSERT_GT(rises(3), 0);
  EXPECT_TRUE(project(camera, {std::sqrt(first) - 1e-6, 0, 1}));
  EXPECT_FALSE(project(camera, {std::sqrt(first) + 1e-6, 0, 1}));
  EXPECT_FALSE(project(camera, {std::sqrt(3.), 0, 1}));
  // A dip of a hair's width, which samples of the mapping would miss: (1 - q)^2 (1 + q) less 1e-7.
  const CameraModel narrow{"",  640, 480, 300,
                           300, 320, 240, PlumbBob{.k1 = -(1 + 1e-7) / 3, .k2 = -1. / 5, .k3 = 1. / 7}};
  EXPECT_TRUE(project(narrow, {.999, 0, 1}));
  EXPECT_FALSE(project(narrow, {1.002, 0, 1}));
  EXPECT_FALSE(project(narrow, {1.3, 0, 1}));
}

TEST(CameraModel, EquidistantStopsWhereItsAngleStopsToRise) {
  const CameraModel camera{"", 640, 480, 200, 200, 320, 240, Equidistant{.k1 = -1. / 3}};
  EXPECT_TRUE(project(camera, {std::sin(.999), 0, std::cos(.999)}));
  EXPECT_FALSE(project(camera, {std::sin(1.001), 0, std::cos(1.001)}));
  EXPECT_FALSE(unproject(camera, {320 + 200 * 2. / 3 + .01, 240}));
  const CameraModel bare{"", 640, 480, 50, 50, 320, 240, Equidistant{}};
  EXPECT_TRUE(unproject(bare, {320 + 50 * 3.14, 240}));
  EXPECT_FALSE(unproject(bare, {320 + 50 * 3.15, 240}));
}

TEST(CameraModel, HalconParametersRoundTrip) {
  // div_lenz.yaml of msl98: the same lens as div.yaml
  const HalconDivision lenz{
      .f = .0027, .kappa = -20000, .sx = 1.25e-5, .sy = 1.52e-5, .cx = 187.3, .cy = 88.9, .width = 384, .height = 172};
  const CameraModel camera = from_halcon(lenz);
  EXPECT_NO_THROW(camera.check());
  EXPECT_NEAR(camera.fx, kDiv.fx, 1e-9);
  EXPECT_NEAR(camera.fy, kDiv.fy, 1e-9);
  EXPECT_NEAR(std::get<Division>(camera.distortion).k, -.1458, 1e-12);
  const HalconDivision back = to_halcon(camera, 1.25e-5);
  EXPECT_NEAR(back.f, lenz.f, 1e-15);
  EXPECT_NEAR(back.kappa, lenz.kappa, 1e-6);
  EXPECT_NEAR(back.sy, lenz.sy, 1e-17);
  EXPECT_EQ(back.cx, lenz.cx);
  EXPECT_EQ(back.cy, lenz.cy);
  EXPECT_EQ(back.width, lenz.width);
  EXPECT_EQ(back.height, lenz.height);
  EXPECT_THROW(to_halcon(kVga, 1e-5), Error);
  EXPECT_THROW(to_halcon(kDiv, 0), Error);
}

std::string refusal(const CameraModel& camera) {
  try {
    camera.check();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(CameraModel, CheckNamesTheField) {
  using ::testing::StartsWith;
  const auto with = [](auto change) {
    CameraModel camera = kVga;
    change(camera);
    return refusal(camera);
  };
  EXPECT_THAT(with([](CameraModel& c) { c.width = 0; }), StartsWith("image_width: is 0"));
  EXPECT_THAT(with([](CameraModel& c) { c.height = -3; }), StartsWith("image_height: is -3"));
  EXPECT_THAT(with([](CameraModel& c) { c.fx = 0; }), StartsWith("fx: is 0"));
  EXPECT_THAT(with([](CameraModel& c) { c.fy = NAN; }), StartsWith("fy: is nan"));
  EXPECT_THAT(with([](CameraModel& c) { c.cx = 1281; }), StartsWith("cx: is 1281.0, must be within -640 and 1280"));
  EXPECT_THAT(with([](CameraModel& c) { c.cy = -481; }), StartsWith("cy: is -481"));
  EXPECT_THAT(with([](CameraModel& c) { c.distortion = Division{INFINITY}; }), StartsWith("distortion_coefficients"));
  EXPECT_THAT(with([](CameraModel& c) { c.distortion = PlumbBob{.k1 = -1}; }),
              StartsWith("distortion_coefficients: plumb_bob folds before the image corner"));
}

// The calibration views of msl98 carry exact projections of known points: X_cam = R X + t.

/// The numbers of the first list after `key` at or behind `at`; `at` moves behind it. Nested lists come out flat.
std::vector<double> next_list(const std::string& text, const std::string& key, std::size_t& at) {
  std::vector<double> out;
  at = text.find("\"" + key + "\":[", at);
  if (at == std::string::npos) return out;
  at += key.size() + 3;
  int depth = 0;
  do {
    const char c = text[at];
    if (c == '[' || c == ']' || c == ',' || c == ' ') {
      depth += c == '[' ? 1 : c == ']' ? -1 : 0;
      ++at;
    } else {
      std::size_t used = 0;
      out.push_back(std::stod(text.substr(at, 24), &used));
      at += used;
    }
  } while (depth > 0);
  return out;
}

class CalibrationViews : public ::testing::TestWithParam<CameraModel> {};

TEST_P(CalibrationViews, AgreeWithTheTruePixels) {
  const CameraModel& camera = GetParam();
  const std::string path = TASSILO_SOURCE_DIR "/../shared/data/msl98/calibration/" + camera.name + "/poses.json";
  std::ifstream file(path);
  if (!file) GTEST_SKIP() << "needs ../shared/data/msl98/calibration";
  std::stringstream content;
  content << file.rdbuf();
  const std::string text = content.str();

  constexpr double spacing = .04;  // squares of the checkerboard and pitch of the dots [m]
  std::size_t at = 0;
  int points = 0;
  while (true) {
    const auto r = next_list(text, "R", at);
    if (r.empty()) break;
    const auto t = next_list(text, "t", at);
    const auto pixels = next_list(text, "true_px", at);
    ASSERT_EQ(r.size(), 9u);
    ASSERT_EQ(t.size(), 3u);
    ASSERT_THAT(pixels.size(), ::testing::AnyOf(2u * 9 * 6, 2u * 7 * 7));
    const std::size_t columns = pixels.size() == 2u * 9 * 6 ? 9 : 7;
    for (std::size_t i = 0; i < pixels.size() / 2; ++i, ++points) {
      const double x = spacing * static_cast<double>(i % columns), y = spacing * static_cast<double>(i / columns);
      const auto pixel =
          project(camera, {r[0] * x + r[1] * y + t[0], r[3] * x + r[4] * y + t[1], r[6] * x + r[7] * y + t[2]});
      ASSERT_TRUE(pixel);
      EXPECT_LT(distance(*pixel, {pixels[2 * i], pixels[2 * i + 1]}), 1e-3);
    }
  }
  EXPECT_GT(points, 150);
}
INSTANTIATE_TEST_SUITE_P(Msl98, CalibrationViews, ::testing::Values(kDiv, kVga, kXga),
                         [](const auto& view) { return view.param.name; });

// ------------------------------------------------------------------------------------------------ mount and floor

TEST(CameraMount, LevelCameraFollowsThePaper) {
  // P = h / p_y [p_x, p_y, f] for the undistorted pixel relative to the principal point, optical frame.
  const MountedCamera camera(kPinhole, {.x = .1, .y = -.03, .z = .5});
  for (const PixelPoint pixel : {PixelPoint{100, 300}, PixelPoint{322.8, 479}, PixelPoint{600, 250}}) {
    const double px = (pixel.x - kPinhole.cx) / kPinhole.fx, py = (pixel.y - kPinhole.cy) / kPinhole.fy;
    const auto point = camera.floor_point(pixel);
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->x, .1 + .5 / py, 1e-12 * point->x);
    EXPECT_NEAR(point->y, -.03 - .5 / py * px, 1e-12 * point->x);
  }
  EXPECT_FALSE(camera.floor_point({300, kPinhole.cy}));
  EXPECT_FALSE(camera.floor_point({300, 100}));
}

TEST(CameraMount, SignsOfTheAngles) {
  const double angle = .2;
  const auto axis = [](CameraMount mount) { return MountedCamera(kPinhole, mount).robot_from_optical({0, 0, 1}); };
  const RobotPoint down = axis({.z = 1, .pitch = angle});
  EXPECT_NEAR(down.x, std::cos(angle), 1e-15);
  EXPECT_NEAR(down.z, -std::sin(angle), 1e-15);
  const RobotPoint left = axis({.z = 1, .yaw = angle});
  EXPECT_NEAR(left.y, std::sin(angle), 1e-15);
  // roll > 0 turns y (left) to z (up): the image's right side gets lower.
  const RobotPoint right = MountedCamera(kPinhole, {.z = 1, .roll = angle}).robot_from_optical({1, 0, 0});
  EXPECT_NEAR(right.y, -std::cos(angle), 1e-15);
  EXPECT_NEAR(right.z, -std::sin(angle), 1e-15);
  // Rz Ry Rx: with all three, the axis is turned by pitch first, then by yaw, whatever the roll.
  const RobotPoint all = axis({.z = 1, .roll = .5, .pitch = angle, .yaw = .3});
  EXPECT_NEAR(all.x, std::cos(.3) * std::cos(angle), 1e-15);
  EXPECT_NEAR(all.y, std::sin(.3) * std::cos(angle), 1e-15);
  EXPECT_NEAR(all.z, -std::sin(angle), 1e-15);
}

const CameraMount kTilted{.x = .06, .y = .015, .z = .52, .roll = .07, .pitch = .24, .yaw = -.14};

TEST(MountedCamera, FloorPointsShowWhereTheyWereTaken) {
  for (const CameraModel& model : cameras()) {
    SCOPED_TRACE(model.name);
    const MountedCamera camera(model, kTilted);
    int met = 0;
    for (const PixelPoint pixel : grid_with_corners(model)) {
      for (const double height : {0., .11}) {
        const auto point = camera.floor_point(pixel, height, 30);
        const auto ray = camera.ray(pixel);
        ASSERT_TRUE(ray);
        if (!point) {
          EXPECT_GT(ray->z, -.52 / 30);  // level or up
          continue;
        }
        ++met;
        const auto back = camera.project({point->x, point->y, height});
        ASSERT_TRUE(back);
        EXPECT_LT(distance(*back, pixel), 1e-8);
      }
    }
    EXPECT_GT(met, 300);
  }
}

TEST(MountedCamera, RotationsAreInverse) {
  const MountedCamera camera(kDiv, kTilted);
  const OpticalPoint v{.3, -1.2, 2.5};
  EXPECT_LT(norm(camera.optical_from_robot(camera.robot_from_optical(v)) - v), 1e-15);
  EXPECT_NEAR(norm(camera.robot_from_optical(v)), norm(v), 1e-15);
}

TEST(MountedCamera, RangeIsFromTheCamerasFoot) {
  const MountedCamera camera(kPinhole, {.x = 5, .z = .5});
  const auto pixel = camera.project({5 + 19.9, 0, 0}), further = camera.project({5 + 20.1, 0, 0});
  ASSERT_TRUE(pixel && further);
  EXPECT_TRUE(camera.floor_point(*pixel, 0, 20));
  EXPECT_FALSE(camera.floor_point(*further, 0, 20));
}

TEST(MountedCamera, PlaneAboveTheCameraIsMetAboveTheHorizon) {
  const MountedCamera camera(kPinhole, {.z = .5});
  EXPECT_TRUE(camera.floor_point({320, 100}, .9));
  EXPECT_FALSE(camera.floor_point({320, 400}, .9));
  EXPECT_FALSE(camera.floor_point({320, 400}, .5));
}

TEST(CameraMount, CheckNamesTheField) {
  using ::testing::StartsWith;
  const auto refused = [](CameraMount mount) -> std::string {
    try {
      mount.check();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused(kTilted), "");
  EXPECT_THAT(refused({.x = NAN, .z = 1}), StartsWith("x: "));
  EXPECT_THAT(refused({.y = INFINITY, .z = 1}), StartsWith("y: "));
  EXPECT_THAT(refused({.z = 0}), StartsWith("z: is 0"));
  EXPECT_THAT(refused({.z = 1, .roll = 4}), StartsWith("roll: is 4"));
  EXPECT_THAT(refused({.z = 1, .pitch = NAN}), StartsWith("pitch: "));
  EXPECT_THAT(refused({.z = 1, .yaw = -3.2}), StartsWith("yaw: "));
}

TEST(GroundMap, HoldsTheFloorPointOfEveryPixelCentre) {
  for (const CameraModel& model : {kDiv, kVga}) {
    SCOPED_TRACE(model.name);
    const MountedCamera camera(model, kTilted);
    const GroundMap map(camera, 12);
    ASSERT_EQ(map.width(), model.width);
    ASSERT_EQ(map.height(), model.height);
    int met = 0;
    for (int row = 0; row < model.height; ++row) {
      for (int column = 0; column < model.width; ++column) {
        const auto exact = camera.floor_point({double(column), double(row)}, 0, 12);
        const auto held = map.at(column, row);
        ASSERT_EQ(exact.has_value(), held.has_value()) << column << ", " << row;
        if (!exact) continue;
        ++met;
        ASSERT_EQ(held->x, static_cast<float>(exact->x));
        ASSERT_EQ(held->y, static_cast<float>(exact->y));
      }
    }
    EXPECT_GT(met, model.width * model.height / 3);
    EXPECT_LT(met, model.width * model.height);
  }
}

TEST(FloorGaussian, EqualsNumericDerivatives) {
  const MountSigma sigma{.x = .01, .y = .02, .z = .003, .roll = .004, .pitch = .005, .yaw = .006};
  double CameraMount::*const fields[] = {&CameraMount::x,    &CameraMount::y,     &CameraMount::z,
                                         &CameraMount::roll, &CameraMount::pitch, &CameraMount::yaw};
  const double sigmas[] = {sigma.x, sigma.y, sigma.z, sigma.roll, sigma.pitch, sigma.yaw};
  for (const CameraModel& model : cameras()) {
    SCOPED_TRACE(model.name);
    for (const double height : {0., .2}) {
      const PixelPoint pixel{model.width * .3, model.height * .8};
      const MountedCamera camera(model, kTilted);
      const auto floor = [&](const CameraMount& mount, PixelPoint p) -> Eigen::Vector2d {
        const auto point = MountedCamera(model, mount).floor_point(p, height);
        return {point->x, point->y};
      };
      const auto add = [](Eigen::Matrix2d& sum, const Eigen::Vector2d& d, double s) {
        sum += s * s * d * d.transpose();
      };

      Eigen::Matrix2d pixels = Eigen::Matrix2d::Zero();
      const double h = 1e-4;
      add(pixels, (floor(kTilted, {pixel.x + h, pixel.y}) - floor(kTilted, {pixel.x - h, pixel.y})) / (2 * h), .7);
      add(pixels, (floor(kTilted, {pixel.x, pixel.y + h}) - floor(kTilted, {pixel.x, pixel.y - h})) / (2 * h), .7);
      const auto from_pixel = floor_gaussian(camera, pixel, .7, {0, 0, 0, 0, 0, 0}, height);
      ASSERT_TRUE(from_pixel);
      EXPECT_LT((from_pixel->covariance - pixels).norm(), 1e-6 * pixels.norm());

      Eigen::Matrix2d both = pixels;
      for (std::size_t i = 0; i < 6; ++i) {
        CameraMount more = kTilted, less = kTilted;
        more.*fields[i] += 1e-6;
        less.*fields[i] -= 1e-6;
        add(both, (floor(more, pixel) - floor(less, pixel)) / 2e-6, sigmas[i]);
      }
      const auto all = floor_gaussian(camera, pixel, .7, sigma, height);
      ASSERT_TRUE(all);
      EXPECT_LT((all->covariance - both).norm(), 1e-6 * both.norm());
      EXPECT_EQ(all->mean, *camera.floor_point(pixel, height));
      EXPECT_EQ(all->covariance(0, 1), all->covariance(1, 0));
      EXPECT_GT(all->covariance.selfadjointView<Eigen::Lower>().eigenvalues()(0), 0);
    }
  }
}

TEST(FloorGaussian, EqualsMonteCarlo) {
  const MountSigma sigma{.x = .002, .y = .002, .z = .002, .roll = .002, .pitch = .002, .yaw = .002};
  const MountedCamera camera(kVga, kTilted);
  const PixelPoint pixel{200, 330};
  const auto expected = floor_gaussian(camera, pixel, .5, sigma);
  ASSERT_TRUE(expected);

  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  constexpr int n = 40000;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (int i = 0; i < n; ++i) {
    CameraMount mount = kTilted;
    mount.x += sigma.x * normal(random);
    mount.y += sigma.y * normal(random);
    mount.z += sigma.z * normal(random);
    mount.roll += sigma.roll * normal(random);
    mount.pitch += sigma.pitch * normal(random);
    mount.yaw += sigma.yaw * normal(random);
    const auto point =
        MountedCamera(kVga, mount).floor_point({pixel.x + .5 * normal(random), pixel.y + .5 * normal(random)});
    ASSERT_TRUE(point);
    const Eigen::Vector2d off(point->x - expected->mean.x, point->y - expected->mean.y);
    sum += off;
    squares += off * off.transpose();
  }
  const Eigen::Vector2d bias = sum / n;
  const Eigen::Matrix2d sampled = squares / n - bias * bias.transpose();
  EXPECT_LT((sampled - expected->covariance).norm(), .03 * expected->covariance.norm());
  EXPECT_LT(bias.norm(), .1 * std::sqrt(expected->covariance.trace()));
}

TEST(FloorShift, ThereAndBackAgain) {
  const CameraMount from{.06, .015, .52, .007, .244, -.014}, to{.07, .01, .55, -.02, .26, .03};
  for (const FloorPoint at : {FloorPoint{1, .2}, FloorPoint{3, -1}, FloorPoint{5, 2}}) {
    const auto moved = floor_point_moved(from, to, at);
    ASSERT_TRUE(moved);
    const auto back = floor_point_moved(to, from, *moved);
    ASSERT_TRUE(back);
    EXPECT_NEAR(distance(*back, at), 0, 1e-9);
  }
}

TEST(FloorShift, IsWhatGeometrySays) {
  const CameraMount from{0, 0, .5, 0, .2, 0};
  CameraMount to = from;
  EXPECT_NEAR(floor_shift(from, to), 0, 1e-12);
  constexpr double step = 1e-6;
  to.z += step;  // similar triangles
  EXPECT_NEAR(floor_shift(from, to) / step, 3 / .5, 1e-3);
  to = from;
  to.yaw += step;
  EXPECT_NEAR(floor_shift(from, to) / step, 3, 1e-3);
  to = from;
  to.pitch += step;  // straight ahead: a ray's height over the floor and its length
  EXPECT_NEAR(floor_shift(from, to) / step, (9 + .25) / .5, 1e-2);
  to.pitch = -.5;
  EXPECT_TRUE(std::isinf(floor_shift(from, to)));
}

TEST(FloorGaussian, NothingWithoutFloor) {
  EXPECT_FALSE(floor_gaussian(MountedCamera(kVga, kTilted), {320, 2}, 1, {}));
}

}  // namespace
}  // namespace tassilo
