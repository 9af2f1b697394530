#include "tassilo/localize/boundary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/camera/test_world.h"
#include "tassilo/localize/boundary_pose.h"
#include "tassilo/localize/test_world.h"
#include "tassilo/region/raster.h"

namespace tassilo {
namespace {

/// What a camera sees of a carpet within four white walls: regions and brightness.
struct SeenBox {
  FrameBuffer buffer;
  Region wall, field, blue_goal;
};

/// With the +x goal as a blue opening in its wall. Noise of two gray levels.
SeenBox see_box(const MountedCamera& camera, const FieldFromRobot& field_from_robot, const FieldModel& field,
                unsigned seed) {
  const int width = camera.model().width, height = camera.model().height;
  SeenBox seen;
  seen.buffer = make_frame_buffer(PixelFormat::yuv422p, width, height, ColorRange::limited);
  std::mt19937 random(static_cast<unsigned>(seed));
  std::normal_distribution<double> noise(0, 2);
  enum Kind : std::uint8_t { hall, carpet, wall, goal };
  const auto look = [&](PixelPoint pixel) {
    const auto ray = camera.ray(pixel);
    if (!ray) return hall;
    const RobotPoint eye = camera.center();
    const FieldPoint from = field_from_robot * FloorPoint{eye.x, eye.y};
    const FieldPoint to = field_from_robot * FloorPoint{eye.x + ray->x, eye.y + ray->y};
    const FieldPoint way = to - from;
    // The nearest wall in this direction.
    const double along_x = way.x > 0 ? (field.walls->x.high - from.x) / way.x : (field.walls->x.low - from.x) / way.x;
    const double along_y = way.y > 0 ? (field.walls->y.high - from.y) / way.y : (field.walls->y.low - from.y) / way.y;
    const double along = std::min(along_x, along_y), z = eye.z + along * ray->z;
    if (z < 0) return carpet;
    if (along_x < along_y && way.x > 0 && std::abs(from.y + along * way.y) < 0.75 && z < 0.9) return goal;
    return z < field.walls->height ? wall : hall;
  };
  const auto brightness = [](Kind kind) {
    return kind == carpet ? 90. : kind == wall ? 200. : kind == goal ? 60. : 110.;
  };
  std::vector<std::uint8_t> kinds(static_cast<std::size_t>(width * height));
  for (int r = 0; r < height; ++r)
    for (int c = 0; c < width; ++c) {
      kinds[static_cast<std::size_t>(r * width + c)] = look({static_cast<double>(c), static_cast<double>(r)});
      double sum = 0;
      for (const double dc : {-.25, .25})
        for (const double dr : {-.25, .25}) sum += brightness(look({c + dc, r + dr})) / 4;
      seen.buffer.planes[0][r * seen.buffer.strides[0] + c] =
          static_cast<std::uint8_t>(std::lround(sum + noise(random)));
    }
  const auto region = [&](Kind kind) {
    return region_where({kinds.data(), width, height, width}, [&](int value) { return value == kind; });
  };
  seen.wall = region(wall);
  seen.field = region(carpet);
  seen.blue_goal = region(goal);
  return seen;
}

std::vector<FieldFromRobot> poses() {
  std::vector<FieldFromRobot> all;
  std::mt19937 random(4);
  const auto from = [&](double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>()(random);
  };
  for (int k = 0; k < 8; ++k)
    all.push_back(make_pose2<FieldFrame, RobotFrame>(from(-2.5, 2.5), from(-1.2, 1.2), from(-3, 3)));
  return all;
}

double distance_from_walls(FieldPoint p, const FieldModel& field) {
  const Interval &x = field.walls->x, &y = field.walls->y;
  return std::min({std::abs(p.x - x.low), std::abs(p.x - x.high), std::abs(p.y - y.low), std::abs(p.y - y.high)});
}

TEST(FindBoundary, SegmentsLieAtTheFeetOfWalls) {
  const FieldModel field = test::plain_field(true);
  for (const MountedCamera& camera : test::cameras()) {
    const RayMap rays(camera.model());
    std::vector<SeenBox> views;
    for (const FieldFromRobot& pose : poses()) views.push_back(see_box(camera, pose, field, 1 + views.size()));
    for (const BoundaryMethod method : {BoundaryMethod::skeleton, BoundaryMethod::subpixel}) {
      int found = 0;
      double worst = 0;
      for (std::size_t k = 0; k < views.size(); ++k) {
        const FieldFromRobot pose = poses()[k];
        const Boundary boundary =
            find_boundary(views[k].buffer.frame.view, views[k].wall, views[k].field, camera, rays, {.method = method});
        found += !boundary.segments.empty();
        for (const BoundarySegment& segment : boundary.segments)
          for (const FloorPoint end : {segment.p, segment.q}) {
            // Far away a pixel is long.
            const double pixel = 1 / std::min(camera.model().fx, camera.model().fy) * dot(end, end) / camera.center().z;
            worst = std::max(worst, distance_from_walls(pose * end, field) / (0.02 + 3 * pixel));
          }
      }
      EXPECT_GE(found, 6);
      EXPECT_LT(worst, 1);
    }
  }
}

TEST(FindBoundary, IsEmptyWithoutAWall) {
  const auto cameras = test::cameras();
  const MountedCamera& camera = cameras.front();
  const FrameBuffer buffer =
      make_frame_buffer(PixelFormat::yuv422p, camera.model().width, camera.model().height, ColorRange::limited);
  const Region field = Region::from_box({0, 50, camera.model().width, camera.model().height});
  EXPECT_TRUE(find_boundary(buffer.frame.view, {}, field, camera, RayMap(camera.model())).segments.empty());
  EXPECT_TRUE(find_boundary(buffer.frame.view, field, {}, camera, RayMap(camera.model())).segments.empty());
}

TEST(BoundaryOptions, OutOfRangeAreNamed) {
  BoundaryOptions options;
  options.split_px = 0;
  EXPECT_THROW(options.check(), Error);
}

// Constructed scenes: segments in the robot's frame, ends in the image by projection.
class PoseByBoundary : public testing::Test {
 protected:
  BoundarySegment segment(FieldPoint a, FieldPoint b, const FieldFromRobot& pose) const {
    const auto robot_from_field = inverse(pose);
    BoundarySegment one;
    one.p = robot_from_field * a;
    one.q = robot_from_field * b;
    one.points = 100;
    one.residual_px = 0.3;
    one.image_p = camera.project({one.p.x, one.p.y, 0}).value();
    one.image_q = camera.project({one.q.x, one.q.y, 0}).value();
    return one;
  }
  Region goal_beside(const FieldFromRobot& pose, double x, double y0, double y1) const {
    const auto robot_from_field = inverse(pose);
    const FloorPoint a = robot_from_field * FieldPoint{x, y0}, b = robot_from_field * FieldPoint{x, y1};
    const PixelPoint pa = camera.project({a.x, a.y, 0}).value(), pb = camera.project({b.x, b.y, 0}).value();
    return Region::from_box({static_cast<int>(std::min(pa.x, pb.x)), static_cast<int>(std::min(pa.y, pb.y)) - 40,
                             static_cast<int>(std::max(pa.x, pb.x)), static_cast<int>(std::max(pa.y, pb.y))});
  }
  static void expect_near(const PoseGaussian& pose, const FieldFromRobot& truth, double place, double turn) {
    EXPECT_LT(std::hypot(pose.x - truth.x, pose.y - truth.y), place);
    EXPECT_LT(std::abs(wrap_angle(pose.theta - truth.theta())), turn);
  }

  MountedCamera camera = test::cameras().front();
  FieldTarget target{test::plain_field(true)};
  FieldFromRobot truth = make_pose2<FieldFrame, RobotFrame>(1.5, 0.2, 0.25);
  BoundarySegment end = segment({4.11, 0.8}, {4.11, 2.0}, truth), side = segment({2.8, 2.2875}, {4.0, 2.2875}, truth);
};

TEST_F(PoseByBoundary, AGoalItsEndLineAndASideLineNeedNoPrior) {
  const std::vector<BoundarySegment> segments{side, end};
  const std::vector<GoalInImage> goals{{GoalColor::blue, goal_beside(truth, 4.11, -0.75, 0.75)}};
  const BoundaryFix fix = pose_by_boundary(target, {segments, goals, camera}, {});
  ASSERT_TRUE(fix.pose);
  EXPECT_EQ(fix.kind, PoseKind::two_lines);
  EXPECT_EQ(fix.why, "x_plus, y_plus");
  expect_near(*fix.pose, truth, 0.01, 0.01);
}

TEST_F(PoseByBoundary, WithoutAGoalTheOrientationDecidesUpToFortyFiveDegrees) {
  const std::vector<BoundarySegment> segments{end, side};
  for (const double off : {-40., -20., 20., 40.}) {
    const PoseGaussian before = pose_gaussian(1.4, 0.3, truth.theta() + radians(off), 0.3, radians(60));
    const BoundaryFix fix = pose_by_boundary(target, {segments, {}, camera}, before);
    EXPECT_EQ(fix.kind, PoseKind::two_lines);
    expect_near(*fix.pose, truth, 0.05, 0.03);
  }
  const PoseGaussian turned = pose_gaussian(1.4, 0.3, truth.theta() + radians(50), 0.3, radians(60));
  const BoundaryFix wrong = pose_by_boundary(target, {segments, {}, camera}, turned);
  EXPECT_GT(std::abs(wrap_angle(wrong.pose->theta - truth.theta())), radians(80)) << "a quarter turn off, as told";
}

TEST_F(PoseByBoundary, OneLineTellsOrientationAndDistance) {
  const std::vector<BoundarySegment> segments{end};
  const PoseGaussian before = pose_gaussian(1.2, 0.5, truth.theta() + 0.2, 0.4, 0.3);
  const BoundaryFix fix = pose_by_boundary(target, {segments, {}, camera}, before);
  EXPECT_EQ(fix.kind, PoseKind::one_line);
  EXPECT_NEAR(fix.pose->x, truth.x, 0.06);
  EXPECT_NEAR(fix.pose->theta, truth.theta(), 0.03);
  EXPECT_NEAR(fix.pose->y, 0.5, 0.02) << "along the line as before";
  EXPECT_LT(fix.pose->covariance(0, 0), 0.03);
  EXPECT_NEAR(fix.pose->covariance(1, 1), 0.16, 0.01);
}

TEST_F(PoseByBoundary, NothingSeenLeavesThePrediction) {
  const PoseGaussian before = pose_gaussian(1.2, 0.5, 0.2, 0.4, 0.3);
  const BoundaryFix fix = pose_by_boundary(target, {{}, {}, camera}, before);
  EXPECT_EQ(fix.kind, PoseKind::predicted);
  EXPECT_EQ(fix.pose->x, 1.2);
  EXPECT_FALSE(pose_by_boundary(target, {{}, {}, camera}, {}).pose);
}

TEST_F(PoseByBoundary, WithoutGoalOrPriorNothingIsGuessed) {
  const std::vector<BoundarySegment> segments{end, side};
  const BoundaryFix fix = pose_by_boundary(target, {segments, {}, camera}, {});
  EXPECT_FALSE(fix.pose);
  EXPECT_FALSE(fix.why.empty());
}

TEST_F(PoseByBoundary, ALineFartherThanTheFieldIsWideIsRefused) {
  BoundarySegment banner = side;  // the rim of a banner behind the wall
  banner.p = banner.p + 4.0 * FloorPoint{std::sin(truth.theta()), std::cos(truth.theta())};
  banner.q = banner.q + 4.0 * FloorPoint{std::sin(truth.theta()), std::cos(truth.theta())};
  const PoseGaussian before = pose_gaussian(1.5, 0.2, 0.25, 0.2, 0.1);
  const std::vector<BoundarySegment> segments{banner};
  const BoundaryFix fix = pose_by_boundary(target, {segments, {}, camera}, before);
  EXPECT_EQ(fix.kind, PoseKind::predicted);
  EXPECT_NE(fix.why.find("farther"), RecycledString::npos) << fix.why;
}

TEST_F(PoseByBoundary, TheSideLineIsLeftOrRightAsItLiesBesideTheGoal) {
  for (const bool plus : {true, false})
    for (const bool left : {true, false}) {
      SCOPED_TRACE(testing::Message() << (plus ? "blue" : "yellow") << (left ? " left" : " right"));
      const double x = plus ? 4.11 : -4.11;
      const double y = (left == plus ? 1 : -1) * 2.2875;
      const FieldFromRobot pose = make_pose2<FieldFrame, RobotFrame>(
          plus ? 1.5 : -1.5, 0.1 * y, (plus ? 0 : std::numbers::pi) + (left ? 0.25 : -0.25));
      const std::vector<BoundarySegment> segments{segment({0.7 * x, y}, {0.97 * x, y}, pose),
                                                  segment({x, 0.35 * y}, {x, 0.9 * y}, pose)};
      const std::vector<GoalInImage> goals{
          {plus ? GoalColor::blue : GoalColor::yellow, goal_beside(pose, x, -0.75, 0.75)}};
      const BoundaryFix fix = pose_by_boundary(target, {segments, goals, camera}, {});
      ASSERT_TRUE(fix.pose) << fix.why;
      EXPECT_EQ(fix.kind, PoseKind::two_lines);
      expect_near(*fix.pose, pose, 0.02, 0.02);
    }
}

TEST_F(PoseByBoundary, ALineApartFromTheGoalIsNotItsEndLine) {
  const std::vector<BoundarySegment> segments{side};
  const std::vector<GoalInImage> goals{{GoalColor::blue, goal_beside(truth, 4.11, -0.75, 0.2)}};
  const BoundaryFix fix = pose_by_boundary(target, {segments, goals, camera}, {});
  EXPECT_FALSE(fix.pose);
  const BoundaryFix known =
      pose_by_boundary(target, {segments, goals, camera}, pose_gaussian(truth.x, truth.y, truth.theta(), 0.2, 0.1));
  ASSERT_EQ(known.matches.size(), 1u);
  EXPECT_EQ(known.matches[0].wall, "y_plus");
}

// A pair that is not quite orthogonal: the line that is known worse gives way.
TEST_F(PoseByBoundary, APairIsMadeOrthogonal) {
  const auto swung = [&](BoundarySegment one, double angle) {
    const FloorPoint middle = 0.5 * (one.p + one.q), half = 0.5 * (one.q - one.p);
    const FloorPoint turned{std::cos(angle) * half.x - std::sin(angle) * half.y,
                            std::sin(angle) * half.x + std::cos(angle) * half.y};
    one.p = middle - turned;
    one.q = middle + turned;
    return one;
  };
  BoundarySegment vague = swung(end, radians(10));
  vague.sigma_px = 20 * side.sigma_px;
  const std::vector<BoundarySegment> segments{vague, side};
  const BoundaryFix fix =
      pose_by_boundary(target, {segments, {}, camera}, pose_gaussian(truth.x, truth.y, truth.theta(), 0.5, 0.5));
  EXPECT_EQ(fix.kind, PoseKind::two_lines);
  EXPECT_LT(std::abs(wrap_angle(fix.pose->theta - truth.theta())), radians(1));

  const std::vector<BoundarySegment> crooked{swung(end, radians(25)), side};
  const BoundaryFix one =
      pose_by_boundary(target, {crooked, {}, camera}, pose_gaussian(truth.x, truth.y, truth.theta(), 0.5, 0.5));
  EXPECT_EQ(one.kind, PoseKind::one_line) << "beyond 20 degrees they are no pair";
}

TEST_F(PoseByBoundary, ALineThatContradictsIsRefusedAndThenBelieved) {
  const FieldFromRobot carried = make_pose2<FieldFrame, RobotFrame>(-0.5, 0.2, 0.25);
  const std::vector<BoundarySegment> segments{end, side};
  const BoundaryObservation seen{segments, {}, camera};
  PoseBelief belief = belief_in(pose_gaussian(carried.x, carried.y, carried.theta(), 0.05, 0.02), 0);
  RobotMotion still;
  still.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
  int refused = 0;
  for (int frame = 1; frame <= 6; ++frame) {
    const Localized localized = localize_by_boundary(target, belief, still, seen, 0.1 * frame);
    ASSERT_TRUE(localized.pose);
    if (localized.why.find("not where it was expected") != RecycledString::npos) ++refused;
    belief = localized.belief;
  }
  EXPECT_EQ(refused, 3);
  expect_near(belief.hypotheses.front().pose, truth, 0.02, 0.02);
  EXPECT_EQ(belief.doubts, 0);
}

TEST_F(PoseByBoundary, CovarianceGrowsWithOdometryAndShrinksWithLines) {
  RobotMotion driven;
  driven.x = 0.1;
  driven.covariance = Eigen::Vector3d(1e-3, 1e-3, 1e-3).asDiagonal();
  PoseBelief belief = belief_in(pose_gaussian(1.4, 0.2, 0.25, 0.05, 0.05), 0);
  const Localized blind = localize_by_boundary(target, belief, driven, {{}, {}, camera}, 0.5);
  ASSERT_TRUE(blind.pose);
  EXPECT_EQ(blind.pose->kind, PoseKind::predicted);
  EXPECT_DOUBLE_EQ(blind.pose->age, 0.5);
  EXPECT_GT(blind.pose->covariance[0], 0.05 * 0.05);
  const std::vector<BoundarySegment> segments{end};
  const Localized by_one = localize_by_boundary(target, belief, driven, {segments, {}, camera}, 0.5);
  EXPECT_EQ(by_one.pose->kind, PoseKind::one_line);
  EXPECT_EQ(by_one.pose->age, 0);
  EXPECT_LT(by_one.pose->covariance[0], blind.pose->covariance[0]) << "across the line";
  EXPECT_NEAR(by_one.pose->covariance[4], blind.pose->covariance[4], 1e-3) << "along it";
}

// After a change from the model: what was undecided there is not known here.
TEST_F(PoseByBoundary, AnUndecidedBeliefIsNoPrediction) {
  PoseBelief belief = belief_in(pose_gaussian(1.5, 0.2, 0.25, 0.05, 0.05), 0);
  belief.hypotheses.push_back({pose_gaussian(-1.5, -0.2, 0.25 - std::numbers::pi, 0.05, 0.05), 0});
  RobotMotion driven;
  driven.x = 0.2;
  const Localized localized = localize_by_boundary(target, belief, driven, {{}, {}, camera}, 0.1);
  EXPECT_FALSE(localized.pose);
  ASSERT_EQ(localized.belief.hypotheses.size(), 2u) << "but is kept for who knows what to do with it";
  for (std::size_t k = 0; k < 2; ++k) {
    const PoseGaussian expected = moved(belief.hypotheses[k].pose, driven);
    EXPECT_DOUBLE_EQ(localized.belief.hypotheses[k].pose.x, expected.x) << "and moves with the robot";
  }
}

}  // namespace
}  // namespace tassilo
