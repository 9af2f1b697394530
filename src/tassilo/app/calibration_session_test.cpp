#include "tassilo/app/calibration_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <numbers>
#include <set>

#include "tassilo/base/error.h"
#include "tassilo/calibrate/test_targets.h"
#include "tassilo/files/camera_file.h"
#include "tassilo/files/test_folder.h"
#include "tassilo/files/text.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

const CameraModel kCamera{.name = "eye",
                          .width = 320,
                          .height = 240,
                          .fx = 200,
                          .fy = 198,
                          .cx = 161,
                          .cy = 118,
                          .distortion = Division{-.1}};
const CameraMount kMount{.x = .05, .y = 0, .z = .5, .roll = 0, .pitch = .3, .yaw = .01};
constexpr double kDistance = .45;  // [m]

/// A frame with a target whose middle is near `place`.
Frame frame_at(std::int64_t index, PixelPoint place, Eigen::Vector3d turns = {.2, .1, 0}, double distance = kDistance,
               const Target& target = kDots) {
  const TestImage image =
      render(kCamera, target, pose_at(kCamera, target, place, distance, turns), static_cast<unsigned>(index));
  FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv420p, image.width, image.height, ColorRange::full);
  for (int r = 0; r < image.height; ++r)
    std::copy_n(image.pixels.data() + static_cast<std::ptrdiff_t>(r) * image.width, image.width,
                buffer.planes[0] + r * buffer.strides[0]);
  buffer.frame.index = index;
  return buffer.frame;
}

Frame empty_frame(std::int64_t index, int width = kCamera.width, int height = kCamera.height) {
  FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv420p, width, height, ColorRange::full);
  buffer.frame.index = index;
  return buffer.frame;
}

/// As if it were one of a folder.
Frame single(Frame frame) {
  frame.image = "still.png";
  return frame;
}

std::string message_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void wait_until(const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!holds()) {
    ASSERT_LT(std::chrono::steady_clock::now(), end) << "waited in vain";
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

/// What is found in a frame, each with an index of its own.
CalibrationSession::Look look_at(CalibrationSession& session, const Frame& frame) {
  session.see(frame);
  wait_until([&] {
    const auto state = session.state();
    return state.now && state.now->frame == frame.index;
  });
  return *session.state().now;
}

CalibrationSession::State solved(CalibrationSession& session) {
  session.solve();
  wait_until([&] { return !session.state().is_solving; });
  return session.state();
}

/// Twelve views all over the image, tilted to all sides.
void capture_views(CalibrationSession& session) {
  for (int i = 0; i < 12; ++i) {
    const double angle = i * std::numbers::pi / 6, tilt = i % 2 == 0 ? .5 : .25;
    const auto look = look_at(
        session,
        single(frame_at(100 + i, {160 + 55 * std::cos(angle) + 5 * (i % 3), 120 + 30 * std::sin(angle)},
                        {tilt * std::cos(2.3 * angle), tilt * std::sin(2.3 * angle), .4 * i}, .5 + .02 * (i % 4))));
    EXPECT_TRUE(look.is_captured) << i << ": " << look.verdict;
  }
}

TEST(CalibrationSession, CapturesWhatIsAtRestAndNew) {
  CalibrationSession session("");
  session.see(frame_at(0, {160, 120}));
  EXPECT_FALSE(session.state().is_on);
  session.change({.is_on = true, .targets = std::vector{kChecker, kDots}});
  EXPECT_THAT(look_at(session, empty_frame(1)).verdict, StartsWith("no target found: no checker:9x6:0.04: "));
  // Just came: nothing says that it is at rest.
  auto look = look_at(session, frame_at(2, {150, 120}));
  EXPECT_THAT(look.verdict, HasSubstr("was not seen in the last look"));
  ASSERT_TRUE(look.view);
  EXPECT_EQ(look.view->target, kDots);
  // The diagonal has 400 px, so 1 px is the limit.
  look = look_at(session, frame_at(3, {156, 120}));
  EXPECT_THAT(look.verdict, testing::MatchesRegex("moves: [567]\\.[0-9] px since the last look"));
  look = look_at(session, frame_at(4, {156.5, 120}));
  EXPECT_TRUE(look.is_captured) << look.verdict;
  EXPECT_EQ(look.verdict, "captured as view 1");
  EXPECT_EQ(look_at(session, frame_at(5, {156.5, 120})).verdict, "like view 1");
  // Elsewhere, tilted, larger and turned are new; a little of each is not.
  const auto held = [&](std::int64_t index, PixelPoint place, Eigen::Vector3d turns, double distance) {
    look_at(session, frame_at(index, place, turns, distance));
    return look_at(session, frame_at(index + 1, place, turns, distance)).verdict;
  };
  EXPECT_EQ(held(10, {164, 120}, {.2, .1, 0}, kDistance), "like view 1");
  EXPECT_EQ(held(12, {156, 120}, {.25, .1, .05}, .98 * kDistance), "like view 1");
  EXPECT_EQ(held(14, {190, 120}, {.2, .1, 0}, kDistance), "captured as view 2");
  EXPECT_EQ(held(16, {156, 120}, {.2, .1, .3}, kDistance), "captured as view 3");
  EXPECT_EQ(held(18, {156, 120}, {.2, .1, 0}, 1.3 * kDistance), "captured as view 4");
  EXPECT_EQ(held(20, {156, 120}, {-.5, -.3, 0}, kDistance), "captured as view 5");
  EXPECT_EQ(session.state().views.size(), 5u);
  EXPECT_GT(session.state().coverage.share, .1);
}

TEST(CalibrationSession, SingleImagesAreAtRest) {
  CalibrationSession session("");
  session.change({.is_on = true});
  EXPECT_TRUE(look_at(session, single(frame_at(1, {150, 120}))).is_captured);
  EXPECT_TRUE(look_at(session, single(frame_at(2, {190, 130}))).is_captured);
  EXPECT_EQ(look_at(session, single(frame_at(3, {150, 120}))).verdict, "like view 1");
}

TEST(CalibrationSession, WantsFramesOnlyWhileSomebodyDoes) {
  CalibrationSession session("");
  EXPECT_FALSE(session.wants_frame());
  session.watched();
  EXPECT_FALSE(session.wants_frame());
  session.change({.is_on = true, .is_automatic = false});
  EXPECT_TRUE(session.wants_frame());
  look_at(session, empty_frame(1));
  wait_until([&] { return session.wants_frame(); });
  wait_until([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    return !session.wants_frame();
  });
  session.change({.is_automatic = true});
  EXPECT_TRUE(session.wants_frame());
  session.change({.is_on = false});
  EXPECT_FALSE(session.wants_frame());
}

TEST(CalibrationSession, CapturesWhatIsAskedFor) {
  CalibrationSession session("");
  using std::chrono::milliseconds;
  EXPECT_THAT(message_of([&] { session.capture_next(); }), HasSubstr("is not on"));
  session.change({.is_on = true, .is_automatic = false});
  EXPECT_THAT(message_of([&] { session.capture_next(milliseconds(1)); }), HasSubstr("no frame comes"));
  look_at(session, frame_at(1, {150, 120}));
  EXPECT_EQ(look_at(session, frame_at(2, {150, 120})).verdict, "new: at rest, and like no other view");
  const auto asked = [&](const Frame& frame) {
    std::string message;
    std::thread asking([&] { message = message_of([&] { session.capture_next(std::chrono::seconds(60)); }); });
    wait_until([&] { return session.wants_frame(); });
    // It may be that nobody asks yet: the frame is shown until somebody did.
    std::thread showing([&] {
      for (int i = 0; i < 100; ++i) {
        session.see(frame);
        std::this_thread::sleep_for(milliseconds(20));
      }
    });
    asking.join();
    showing.join();
    return message;
  };
  EXPECT_EQ(asked(frame_at(3, {200, 120})), "no error");
  EXPECT_EQ(session.state().views.size(), 1u);
  EXPECT_THAT(asked(empty_frame(4)), HasSubstr("no target found"));
  EXPECT_EQ(session.state().views.size(), 1u);
}

TEST(CalibrationSession, FramesOfAnotherSizeAreNoViews) {
  CalibrationSession session("");
  session.change({.is_on = true});
  EXPECT_EQ(session.state().size.width, 0);
  look_at(session, single(frame_at(1, {150, 120})));
  EXPECT_EQ(session.state().size.width, 320);
  CameraModel half = kCamera;
  half.width = 300;
  const TestImage image = render(half, kDots, pose_at(half, kDots, {150, 120}, kDistance, {0, 0, 0}), 1);
  FrameBuffer buffer = make_frame_buffer(PixelFormat::yuv420p, image.width, image.height, ColorRange::full);
  for (int r = 0; r < image.height; ++r)
    std::copy_n(image.pixels.data() + static_cast<std::ptrdiff_t>(r) * image.width, image.width,
                buffer.planes[0] + r * buffer.strides[0]);
  buffer.frame.index = 2;
  EXPECT_THAT(look_at(session, single(buffer.frame)).verdict, HasSubstr("300 x 240"));
}

TEST(CalibrationSession, GivesTheTrueCameraAndSavesIt) {
  const TestFolder folder;
  const fs::path file = folder / "camera.yaml";
  CameraModel wrong = kCamera;
  wrong.fx = wrong.fy = 250;
  write_camera(file, {wrong, kMount});
  const std::string before = "# measured by hand\n" + read_text(file, 1 << 20);
  std::ofstream(file) << before;
  CalibrationSession session(file);
  EXPECT_EQ(session.state().refusal, "");
  EXPECT_EQ(session.state().model, LensModel::division);
  EXPECT_EQ(session.state().size.width, 320);
  session.change({.is_on = true});
  const auto take_over = [] {};
  EXPECT_THAT(message_of([&] { session.save(take_over); }), HasSubstr("is not worked out"));
  EXPECT_THAT(message_of([&] { session.solve(); }), HasSubstr("must be at least 3"));
  EXPECT_FALSE(session.residuals());
  capture_views(session);

  auto state = solved(session);
  ASSERT_TRUE(state.result) << state.failure;
  EXPECT_LT(state.result->rms_px, .1);
  EXPECT_NEAR(state.result->camera.fx / kCamera.fx, 1, .005);
  EXPECT_NEAR(state.result->camera.fy / kCamera.fy, 1, .005);
  EXPECT_NEAR(state.result->camera.cx, kCamera.cx, 1);
  EXPECT_NEAR(state.result->camera.cy, kCamera.cy, 1);
  EXPECT_NEAR(std::get<Division>(state.result->camera.distortion).k, -.1, .01);
  EXPECT_EQ(state.result->views.size(), state.views.size());
  EXPECT_FALSE(state.is_saved);
  ASSERT_TRUE(session.residuals());
  EXPECT_GE(session.residuals()->width, 900);

  // What the run refuses does not stay in the file.
  EXPECT_THAT(message_of([&] { session.save([] { throw Error("camera", "is refused"); }); }),
              HasSubstr("is as it was"));
  EXPECT_EQ(read_text(file, 1 << 20), before);
  bool is_taken_over = false;
  session.save([&] { is_taken_over = read_text(file, 1 << 20) != before; });
  EXPECT_TRUE(is_taken_over);
  EXPECT_TRUE(session.state().is_saved);
  const CameraFile saved = read_camera(file);
  EXPECT_EQ(saved.mount, kMount);
  EXPECT_EQ(saved.model.name, "eye");
  EXPECT_EQ(saved.model.fx, state.result->camera.fx);
  session.save(take_over);
  session.save(take_over);
  std::set<std::string> kept;
  for (const auto& entry : fs::directory_iterator(folder / "camera_history"))
    kept.insert(read_text(entry.path(), 1 << 20));
  EXPECT_EQ(kept, (std::set{before, read_text(file, 1 << 20)})) << "each once";

  // Whatever it is made of changes: it is gone.
  session.change({.model = LensModel::division});
  EXPECT_TRUE(session.state().result);
  session.change({.model = LensModel::plumb_bob});
  EXPECT_FALSE(session.state().result);
  ASSERT_TRUE(solved(session).result);
  EXPECT_TRUE(session.forget(session.state().views[3].id));
  EXPECT_FALSE(session.forget("4"));
  EXPECT_FALSE(session.state().result);
  EXPECT_EQ(session.state().views.size(), 11u);
  ASSERT_TRUE(solved(session).result);
  EXPECT_FALSE(session.state().is_automatic) << "another view would drop the result";
  session.change({.is_automatic = true});
  look_at(session, single(frame_at(200, {110, 90}, {.6, -.3, 1}, .6)));
  EXPECT_EQ(session.state().views.back().id, "13") << "no id is given twice";
  EXPECT_FALSE(session.state().result);
  session.forget_all();
  EXPECT_TRUE(session.state().views.empty());
}

TEST(CalibrationSession, ReplacesNoFileThatItCannotRead) {
  const TestFolder folder;
  CalibrationSession none("");
  EXPECT_THAT(none.state().refusal, HasSubstr("names no `camera:`"));
  const fs::path file = folder / "camera.yaml";
  CameraModel larger = kCamera;
  larger.width = 640;
  larger.height = 480;
  write_camera(file, {larger, kMount});
  CalibrationSession session(file);
  session.change({.is_on = true});
  capture_views(session);
  ASSERT_TRUE(solved(session).result);
  const auto take_over = [] { FAIL(); };
  EXPECT_THAT(message_of([&] { session.save(take_over); }), HasSubstr("is for images of 640 x 480"));
  std::ofstream(file) << "half a fi";
  EXPECT_NE(session.state().refusal, "");
  EXPECT_THAT(message_of([&] { session.save(take_over); }), HasSubstr("camera.yaml"));
  EXPECT_EQ(read_text(file, 100), "half a fi");
  EXPECT_FALSE(fs::exists(folder / "camera_history"));
  write_camera(file, {kCamera, kMount});
  EXPECT_EQ(session.state().refusal, "");
  session.save([] {});
  EXPECT_EQ(read_camera(file).mount, kMount);
}

TEST(CalibrationSession, TellsWhyItFails) {
  CalibrationSession session("");
  session.change({.is_on = true});
  EXPECT_THAT(message_of([&] { session.change({.targets = std::vector<Target>{}}); }), HasSubstr("must be 1 to 4"));
  EXPECT_THAT(message_of([&] { session.change({.targets = std::vector<Target>(5)}); }), HasSubstr("must be 1 to 4"));
  EXPECT_THAT(message_of([&] { session.change({.targets = std::vector{Target{.pitch = -1}}}); }), HasSubstr("pitch"));
  // Head on, everywhere: distance and focal length cannot be told apart.
  for (int i = 0; i < 3; ++i)
    EXPECT_TRUE(look_at(session, single(frame_at(i + 1, {120. + 30 * i, 120}, {0, 0, 0}, .5))).is_captured);
  const auto state = solved(session);
  if (state.result)
    EXPECT_FALSE(state.result->warnings.empty());
  else
    EXPECT_NE(state.failure, "");
  // What changes while it is at work is not mixed up with it.
  session.solve();
  EXPECT_THAT(message_of([&] { session.solve(); }), testing::AnyOf(HasSubstr("already"), "no error"));
  session.forget("1");
  wait_until([&] { return !session.state().is_solving; });
  EXPECT_FALSE(session.state().result);
}

}  // namespace
}  // namespace tassilo
