#include "tassilo/localize/mount_drift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/localize/test_world.h"

namespace tassilo {
namespace {

const CameraModel kCamera{"div", 384, 172, 216, 177.631578947, 187.3, 88.9, Division{-.1458}};
const CameraMount kTold{.06, .015, .52, .007, .2443, -.014};

/// A robot that drives about for some time, by a camera whose true mount may be another one than it believes.
struct Drive {
  CameraMount truth = kTold;
  unsigned seed = 1;
  double seconds = 10, rate = 10;
  double noise_px = .3, common_px = .3;
  double pose_error = .02;  ///< Of the localization. [m]
};

std::vector<LineMark> marks_from(const FieldTarget& target, const FieldFromRobot& pose, const CameraMount& truth,
                                 const std::vector<double>& common, double noise_px, std::mt19937& random) {
  const MountedCamera real(kCamera, truth), told(kCamera, kTold);
  std::normal_distribution<double> gauss;
  std::vector<LineMark> marks;
  int number = 0;
  const auto robot_from_field = inverse(pose);
  for (std::size_t k = 0; k < target.curves.lines.size(); ++k) {
    const FieldLine& line = target.curves.lines[k];
    const double length = distance(line.p, line.q);
    const FieldPoint along = (1 / length) * (line.q - line.p);
    std::vector<LineMark> all;
    for (double s = 0; s <= length; s += .03) {
      const FloorPoint p = robot_from_field * (line.p + s * along), q = robot_from_field * (line.p + (s + .01) * along);
      const auto here = real.project({p.x, p.y, 0}), next = real.project({q.x, q.y, 0});
      if (norm(p) > 5 || !here || !next || here->x < 0 || here->y < 0 || here->x >= kCamera.width ||
          here->y >= kCamera.height)
        continue;
      const PixelPoint tangent = (1 / distance(*here, *next)) * (*next - *here);
      const PixelPoint seen = *here + (common[k] + noise_px * gauss(random)) * PixelPoint{-tangent.y, tangent.x};
      const auto floor = told.floor_point(seen);
      if (!floor) continue;
      const FloorPoint direction = (1 / distance(p, q)) * (q - p);
      const double range = norm(*floor), sigma = .3 * range * range / (kTold.z * kCamera.fy);
      all.push_back({*floor,
                     {-direction.y, direction.x},
                     sigma,
                     sigma,
                     line.is_wall ? LineKind::boundary : LineKind::line,
                     number,
                     told.center()});
    }
    if (all.size() < 20) continue;
    for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(1, all.size() / 20)) marks.push_back(all[i]);
    ++number;
  }
  return marks;
}

/// The drift after each frame.
std::vector<MountDrift> watch(const Drive& drive) {
  const FieldTarget target(test::plain_field(true));
  const MountedCamera told(kCamera, kTold);
  std::mt19937 random(drive.seed);
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> common(target.curves.lines.size(), 0);
  std::vector<MountDrift> drifts;
  MountDrift drift;
  const double x0 = 2 * uniform(random), y0 = uniform(random), turn = 1.5 * uniform(random),
               start = 3 * uniform(random);
  for (int k = 0; k < static_cast<int>(drive.seconds * drive.rate); ++k) {
    const double t = k / drive.rate;
    // Errors that lines have in common live for half a second.
    const double kept = std::exp(-1 / (drive.rate * .25));
    for (double& error : common)
      error = k == 0 ? drive.common_px * gauss(random)
                     : kept * error + std::sqrt(1 - kept * kept) * drive.common_px * gauss(random);
    const auto pose =
        make_pose2<FieldFrame, RobotFrame>(x0 + .6 * std::sin(.5 * t), y0 + .4 * std::cos(.4 * t), start + turn * t);
    const auto marks = marks_from(target, pose, drive.truth, common, drive.noise_px, random);
    const PoseGaussian believed =
        pose_gaussian(pose.x + drive.pose_error * gauss(random), pose.y + drive.pose_error * gauss(random),
                      pose.theta() + .01 * gauss(random), .02, .01);
    const PoseFit fit = fit_pose(target, {marks, {}, nullptr}, believed);
    drift = watched(drift, target, {told, {0, 0, 0, 0, 0, 0}, marks, fit.line_of, fit.pose, t});
    drifts.push_back(drift);
  }
  return drifts;
}

TEST(MountDrift, IsFoundAsItIs) {
  Drive drive;
  drive.noise_px = drive.common_px = drive.pose_error = 0;
  for (const auto& [z, roll, pitch] : {std::tuple(.0, .0, radians(1)), std::tuple(.02, radians(-1), radians(.5)),
                                       std::tuple(.0, radians(1.5), radians(-1))}) {
    drive.truth = kTold;
    drive.truth.z += z;
    drive.truth.roll += roll;
    drive.truth.pitch += pitch;
    const auto found = drifted(watch(drive).back());
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->z, z, .003);
    EXPECT_NEAR(found->roll, roll, radians(.1));
    EXPECT_NEAR(found->pitch, pitch, radians(.1));
    EXPECT_GT(found->shift, .1);
  }
}

TEST(MountDrift, OneDegreeIsToldInSecondsByEveryDrive) {
  for (const double degree : {-1., 1.})
    for (unsigned seed = 1; seed <= 20; ++seed) {
      SCOPED_TRACE(seed);
      Drive drive{.truth = kTold, .seed = seed};
      drive.truth.pitch += radians(degree);
      const auto found = drifted(watch(drive).back());
      ASSERT_TRUE(found);
      EXPECT_LT(std::abs(found->pitch - radians(degree)), std::max(4 * found->pitch_sigma, radians(.15)));
      EXPECT_NE(to_text(*found).find("pitch"), std::string::npos) << to_text(*found);
    }
}

// In 100 drives of 20 s that have nothing but noise no frame tells of a drift.
TEST(MountDrift, IsSilentWithoutOne) {
  int told = 0;
  for (unsigned seed = 1; seed <= 100; ++seed)
    for (const MountDrift& drift : watch({.seed = seed, .seconds = 20, .rate = 5})) told += drifted(drift).has_value();
  EXPECT_EQ(told, 0);
}

TEST(MountDrift, TooLittleToMatterIsNotTold) {
  Drive drive;
  drive.noise_px = drive.common_px = .02;
  drive.truth.pitch += radians(.15);  // 4 cm at 3 m
  EXPECT_FALSE(drifted(watch(drive).back()));
}

TEST(MountDrift, OneLineTellsNothing) {
  const FieldTarget target(test::plain_field(true));
  const MountedCamera told(kCamera, kTold);
  CameraMount truth = kTold;
  truth.pitch += radians(1);
  std::mt19937 random(3);
  MountDrift drift;
  for (int k = 0; k < 50; ++k) {
    const auto pose = make_pose2<FieldFrame, RobotFrame>(2, 0, .02 * k);
    auto marks = marks_from(target, pose, truth, std::vector<double>(target.curves.lines.size(), 0), .3, random);
    std::erase_if(marks, [&](const LineMark& mark) { return mark.line != 0; });
    drift =
        watched(drift, target, {told, {}, marks, {}, pose_gaussian(pose.x, pose.y, pose.theta(), .02, .01), .1 * k});
  }
  EXPECT_FALSE(drifted(drift));
}

TEST(MountDrift, AnotherMountAndAnotherDriveBeginAnew) {
  const FieldTarget target(test::plain_field(true));
  Drive drive;
  drive.truth.pitch += radians(1);
  const MountDrift drift = watch(drive).back();
  ASSERT_TRUE(drifted(drift));
  const MountedCamera measured(kCamera, drive.truth), told(kCamera, kTold);
  EXPECT_FALSE(drifted(watched(drift, target, {measured, {}, {}, {}, pose_gaussian(0, 0, 0, .1, .1), drift.t + .1})));
  EXPECT_FALSE(drifted(watched(drift, target, {told, {}, {}, {}, pose_gaussian(0, 0, 0, .1, .1), 0})));
  // A frame without lines changes nothing.
  EXPECT_TRUE(drifted(watched(drift, target, {told, {}, {}, {}, pose_gaussian(0, 0, 0, .1, .1), drift.t + .1})));
}

TEST(MountDrift, OptionsAreChecked) {
  MountDriftOptions options;
  options.check();
  options.false_alarm = 1;
  EXPECT_THROW(options.check(), Error);
  options = {.memory = 0};
  EXPECT_THROW(options.check(), Error);
}

}  // namespace
}  // namespace tassilo
