#include "tassilo/vision/vision.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tassilo/base/error.h"
#include "tassilo/camera/test_world.h"
#include "tassilo/detect/test_view.h"

namespace tassilo {
namespace {

VisionSetup setup_for(const MountedCamera& camera) {
  VisionSetup setup;
  setup.colors = test::paint_table();
  setup.field = test::test_field();
  setup.camera = camera.model();
  setup.mount = camera.mount();
  return setup;
}

test::World busy_world() {
  test::World world;
  world.wall_x = 3.5;
  world.spheres.push_back({{1.5, 0.3, 0.105}, 0.105});
  world.robots.push_back({.foot = {2.2, -0.6}, .radius = 0.2, .marker = test::kMagenta});
  world.lines = {{{1.2, -2}, {1.2, 2}}};
  world.goal = {{0.2, 1.7}};
  return world;
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Vision, SeesEverythingAndTimesEveryStage) {
  const MountedCamera camera = test::cameras()[1];
  const Vision vision(setup_for(camera));
  Frame frame = test::render(camera, busy_world());
  frame.index = 7;
  frame.t = 1.25;
  VisionWorkspace workspace;
  const Scene scene = vision(frame, workspace);
  EXPECT_EQ(scene.frame, 7);
  EXPECT_EQ(scene.t, 1.25);
  EXPECT_EQ(scene.balls.size(), 1u);
  EXPECT_EQ(scene.goals.size(), 1u);
  EXPECT_EQ(scene.robots.size(), 1u);
  EXPECT_FALSE(scene.lines.empty());
  EXPECT_TRUE(scene.free_space.has_value());
  ASSERT_FALSE(scene.timing.empty());
  EXPECT_EQ(scene.timing.front().stage, "segment");
  EXPECT_EQ(scene.timing.back().stage, "total");
  double sum = 0;
  for (std::size_t i = 0; i + 1 < scene.timing.size(); ++i) sum += scene.timing[i].ms;
  EXPECT_LE(sum, scene.timing.back().ms + 1e-6);
}

// What a frame shows does not depend on the frames before it: the workspace carries memory, no knowledge.
TEST(Vision, TheWorkspaceCarriesNoKnowledge) {
  const MountedCamera camera = test::cameras()[0];
  const Vision vision(setup_for(camera));
  const Frame busy = test::render(camera, busy_world()), empty = test::render(camera, test::World{});
  VisionWorkspace used, fresh;
  vision(busy, used);
  const Scene after_busy = vision(empty, used), alone = vision(empty, fresh);
  EXPECT_EQ(used.segmentation.labels, fresh.segmentation.labels);
  EXPECT_EQ(used.surface.kinds, fresh.surface.kinds);
  EXPECT_EQ(after_busy.balls.size(), alone.balls.size());
  EXPECT_EQ(after_busy.lines.size(), alone.lines.size());
  EXPECT_EQ(after_busy.free_space->ranges, alone.free_space->ranges);
  EXPECT_EQ(after_busy.free_space->states, alone.free_space->states);
}

TEST(Vision, FollowsBallAndRobots) {
  const MountedCamera camera = test::cameras()[0];
  const Vision vision(setup_for(camera));
  Frame busy = test::render(camera, busy_world());
  VisionWorkspace workspace;
  Scene scene;
  for (int k = 0; k < 5; ++k) {
    busy.t = 0.05 * k;
    scene = vision(busy, workspace);
    ASSERT_FALSE(scene.tracks.empty());
    EXPECT_EQ(scene.tracks[0].kind, TrackKind::ball);
    EXPECT_EQ(scene.tracks[0].id, 1);
    EXPECT_NEAR(scene.tracks[0].x, scene.balls[0].floor->position.mean.x, 1e-3);
  }
  ASSERT_EQ(scene.tracks.size(), 2u);
  EXPECT_EQ(scene.tracks[1].kind, TrackKind::robot);
  EXPECT_EQ(scene.tracks[1].team, scene.robots[0].team);
  // A source that begins again is another drive.
  busy.t = 0;
  EXPECT_EQ(vision(busy, workspace).tracks.size(), 1u);
}

TEST(Vision, WithoutCalibrationItStaysInTheImage) {
  const MountedCamera camera = test::cameras()[1];
  VisionSetup setup = setup_for(camera);
  setup.mount.reset();
  const Vision vision(setup);
  VisionWorkspace workspace;
  const Scene scene = vision(test::render(camera, busy_world()), workspace);
  ASSERT_EQ(scene.balls.size(), 1u);
  EXPECT_FALSE(scene.balls[0].floor.has_value());
  ASSERT_EQ(scene.robots.size(), 1u);
  EXPECT_FALSE(scene.robots[0].floor.has_value());
  ASSERT_EQ(scene.goals.size(), 1u);
  EXPECT_FALSE(scene.goals[0].bearing.has_value());
  EXPECT_FALSE(scene.free_space.has_value());
  EXPECT_TRUE(scene.tracks.empty());
  EXPECT_EQ(vision.optics(), nullptr);
}

TEST(Vision, AnyFrameSizeIsSeenWithoutCalibration) {
  VisionSetup setup = setup_for(test::cameras()[0]);
  setup.camera.reset();
  const Vision vision(setup);
  VisionWorkspace workspace;
  for (const auto& [width, height] : {std::pair(1, 1), {2, 1}, {1, 9}, {7, 5}, {0, 0}}) {
    const Frame frame = make_frame_buffer(PixelFormat::yuv422p, width, height, ColorRange::limited).frame;
    const Scene scene = vision(frame, workspace);
    EXPECT_TRUE(scene.balls.empty()) << width << "x" << height;
    EXPECT_EQ(workspace.segmentation.labels.size(), static_cast<std::size_t>(width * height));
  }
}

TEST(Vision, RefusesFramesItWasNotSetUpFor) {
  const MountedCamera camera = test::cameras()[0];
  const Vision vision(setup_for(camera));
  VisionWorkspace workspace;
  const Frame other = make_frame_buffer(PixelFormat::yuv422p, 640, 480, ColorRange::limited).frame;
  EXPECT_THAT(message_of([&] { vision(other, workspace); }),
              testing::HasSubstr("frame 0: is 640x480, the camera file is for 384x172"));
  const Frame full = test::render(camera, {}, ColorRange::full);
  EXPECT_THAT(message_of([&] { vision(full, workspace); }),
              testing::HasSubstr("has full color range, the color table is for limited range"));
}

TEST(VisionOptions, EveryKeyIsReadAndBounded) {
  for (const OptionInfo& info : vision_option_infos()) {
    SCOPED_TRACE(info.key);
    EXPECT_LE(info.low, info.standard);
    EXPECT_GE(info.high, info.standard);
    const auto options_with = [&](const std::string& text) {
      const std::vector<std::pair<std::string, Setting>> settings{
          {std::string(info.key), Setting{"robot.yaml:3:10", "vision." + std::string(info.key), text}}};
      return vision_options(settings);
    };
    EXPECT_NO_THROW(options_with(number_text(info.standard)));
    EXPECT_THROW(options_with(number_text(info.high + 1)), Error);
    EXPECT_THROW(options_with("many"), Error);
  }
}

// No NaN may reach a covariance, and so a scene.
TEST(VisionOptions, RefusesSigmasThatAreNone) {
  for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    VisionOptions options;
    options.mount_angle_sigma = bad;
    EXPECT_THROW(options.check(), Error);
    options = {};
    options.mount_height_sigma = bad;
    EXPECT_THROW(options.check(), Error);
  }
}

TEST(VisionOptions, AnUnknownKeySaysWhatWasMeant) {
  const std::vector<std::pair<std::string, Setting>> settings{
      {"bal_max", Setting{"robot.yaml:3:10", "vision.bal_max", "3"}}};
  EXPECT_EQ(message_of([&] { vision_options(settings); }),
            "robot.yaml:3:10: unknown key 'vision.bal_max', did you mean 'ball_max'");
}

}  // namespace
}  // namespace tassilo
