#include "tassilo/calibrate/mount_from_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "tassilo/base/error.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {
namespace {

const CameraModel kCamera{"div", 384, 172, 216, 177.631578947, 187.3, 88.9, Division{-.1458}};
const CameraMount kMount{.06, .015, .52, .007, .2443, -.014};

FieldCurves middle_size() {
  FieldModel field;
  field.length = 8.22;
  field.width = 4.575;
  field.line_width = .035;
  field.halfway_line = true;
  field.circle_radius = 1;
  field.areas = {{1, 2.6}};
  field.walls = FieldModel::Walls{.color = "white", .height = .5, .x = {-4.11, 4.11}, .y = {-2.2875, 2.2875}};
  field.goals = {{GoalSide::plus_x, GoalColor::blue, 1.5, .9, .5}, {GoalSide::minus_x, GoalColor::yellow, 1.5, .9, .5}};
  return field_curves(field);
}

/// What a camera shows of the field from a pose, points with noise of one pixel's `sigma` and lines with `common`.
LineFrame frame_from(const MountedCamera& camera, const FieldCurves& field, const FieldFromRobot& pose,
                     std::mt19937& random, double sigma, double common) {
  std::normal_distribution<double> gauss;
  LineFrame frame{pose.x, pose.y, pose.theta(), {}};
  const auto robot_from_field = inverse(pose);
  const auto add = [&](SeenCurve seen, double length, const std::function<FieldPoint(double)>& at) {
    struct Place {
      PixelPoint at, along;
    };
    std::vector<Place> all;
    for (double s = 0; s <= length; s += .02) {
      const FloorPoint p = robot_from_field * at(s), q = robot_from_field * at(s + .001);
      if (norm(p) > 6) continue;
      const auto pixel = camera.project({p.x, p.y, 0}), next = camera.project({q.x, q.y, 0});
      if (pixel && next && pixel->x >= 0 && pixel->y >= 0 && pixel->x < camera.model().width &&
          pixel->y < camera.model().height)
        all.push_back({*pixel, (1 / distance(*pixel, *next)) * (*next - *pixel)});
    }
    if (all.size() < 20) return;
    const double shared = common * gauss(random);
    for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(1, all.size() / 24))
      seen.points.push_back(all[i].at + (shared + sigma * gauss(random)) * PixelPoint{-all[i].along.y, all[i].along.x});
    frame.curves.push_back(std::move(seen));
  };
  for (std::size_t i = 0; i < field.lines.size(); ++i) {
    const FieldLine& line = field.lines[i];
    const double length = distance(line.p, line.q);
    add({false, i, {}, .3}, length, [&](double s) { return line.p + (s / length) * (line.q - line.p); });
  }
  for (std::size_t i = 0; i < field.arcs.size(); ++i) {
    const FieldArc& arc = field.arcs[i];
    add({true, i, {}, .3}, (arc.to - arc.from) * arc.radius, [&](double s) {
      const double a = arc.from + s / arc.radius;
      return arc.center + arc.radius * FieldPoint{std::cos(a), std::sin(a)};
    });
  }
  return frame;
}

std::vector<LineFrame> drive(unsigned seed, double sigma, double common, std::size_t count = 12) {
  const FieldCurves field = middle_size();
  const MountedCamera camera(kCamera, kMount);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(-3, 3), y(-1.6, 1.6), theta(-3.1, 3.1);
  std::normal_distribution<double> gauss;
  std::vector<LineFrame> frames;
  while (frames.size() < count) {
    LineFrame frame = frame_from(camera, field, make_pose2<FieldFrame, RobotFrame>(x(random), y(random), theta(random)),
                                 random, sigma, common);
    if (frame.curves.size() < 2) continue;
    frame.x += .1 * gauss(random);
    frame.y += .1 * gauss(random);
    frame.theta += .03 * gauss(random);
    frames.push_back(std::move(frame));
  }
  return frames;
}

CameraMount disturbed() {
  CameraMount mount = kMount;
  mount.z += .02;
  mount.roll -= radians(1);
  mount.pitch += radians(1.5);
  return mount;
}

TEST(MountFromLines, ExactLinesGiveTheMount) {
  const FieldCurves field = middle_size();
  const MountFromLines result = mount_from_lines({kCamera, disturbed()}, field, drive(1, 0, 0));
  EXPECT_NEAR(result.estimate.mount.z, kMount.z, 2e-4);
  EXPECT_NEAR(result.estimate.mount.roll, kMount.roll, 2e-4);
  EXPECT_NEAR(result.estimate.mount.pitch, kMount.pitch, 2e-4);
  EXPECT_LT(result.rms_px, .05);
  // What nobody can tell stays.
  EXPECT_EQ(result.estimate.mount.x, kMount.x);
  EXPECT_EQ(result.estimate.mount.y, kMount.y);
  EXPECT_EQ(result.estimate.mount.yaw, kMount.yaw);
  EXPECT_EQ(result.estimate.sigma.yaw, 0);
}

TEST(MountFromLines, SigmasAreTrueOrCareful) {
  const FieldCurves field = middle_size();
  constexpr unsigned draws = 40;
  double squares[3]{};
  for (unsigned draw = 0; draw < draws; ++draw) {
    SCOPED_TRACE(draw);
    const EstimatedMount found = mount_from_lines({kCamera, disturbed()}, field, drive(100 + draw, .3, .3)).estimate;
    const double off[]{(found.mount.z - kMount.z) / found.sigma.z, (found.mount.roll - kMount.roll) / found.sigma.roll,
                       (found.mount.pitch - kMount.pitch) / found.sigma.pitch};
    for (int i = 0; i < 3; ++i) {
      EXPECT_LT(std::abs(off[i]), 3.5);
      squares[i] += off[i] * off[i] / draws;
    }
  }
  // Careful: errors that lines share over all frames are allowed for, and here there are none.
  for (const double square : squares) {
    EXPECT_LT(square, 1.5);
    EXPECT_GT(square, .05);
  }
}

TEST(MountFromLines, ALineTakenForAnotherIsThrownOut) {
  const FieldCurves field = middle_size();
  auto frames = drive(7, .3, .3, 20);
  SeenCurve& wrong = frames[3].curves[0];
  ASSERT_FALSE(wrong.is_arc);
  wrong.curve = (wrong.curve + 1) % field.lines.size();
  const MountFromLines result = mount_from_lines({kCamera, disturbed()}, field, frames);
  EXPECT_GE(result.curves_thrown_out, 1U);
  EXPECT_NEAR(result.estimate.mount.pitch, kMount.pitch, 4 * result.estimate.sigma.pitch);
}

TEST(MountFromLines, RefusesWhatLeavesItOpen) {
  const FieldCurves field = middle_size();
  const MountedCamera start(kCamera, kMount);
  EXPECT_THROW(mount_from_lines(start, field, {}), Error);
  // One line in each frame, whichever: where the robot stands explains any mount.
  auto frames = drive(9, .3, .3);
  for (LineFrame& frame : frames) {
    std::erase_if(frame.curves, [](const SeenCurve& seen) { return seen.is_arc; });
    if (frame.curves.size() > 1) frame.curves.resize(1);
  }
  EXPECT_THROW(
      {
        try {
          mount_from_lines(start, field, frames);
        } catch (const Error& error) {
          EXPECT_NE(std::string(error.what()).find("do not determine"), std::string::npos) << error.what();
          throw;
        }
      },
      Error);
}

}  // namespace
}  // namespace tassilo
