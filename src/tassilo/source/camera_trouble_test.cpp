#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <random>
#include <thread>

#include "tassilo/base/error.h"
#include "tassilo/source/frame_source.h"
#include "tassilo/source/internal/frame_reader.h"
#include "tassilo/source/internal/live_camera.h"
#include "tassilo/source/test_camera.h"
#include "tassilo/source/test_clip.h"

namespace tassilo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Kind = CameraStep::Kind;

CameraOptions small() {
  CameraOptions options;
  options.width = 32;
  options.height = 24;
  options.fps = 20;
  return options;
}

/// Grabs until the steps are used up, or about `seconds` have passed on the camera's clock.
std::vector<Frame> grab_all(LiveCamera& camera, FakeCamera& fake, double seconds = 60) {
  std::vector<Frame> frames;
  for (const double end = fake.now + seconds; fake.now < end && !fake.steps.empty();)
    if (auto grabbed = camera.grab(100)) frames.push_back(std::move(grabbed->frame));
  return frames;
}

std::vector<std::int64_t> indices(const std::vector<Frame>& frames) {
  std::vector<std::int64_t> all;
  for (const Frame& frame : frames) all.push_back(frame.index);
  return all;
}

std::vector<CameraState> states(LiveCamera& camera) {
  std::vector<CameraState> all;
  for (const CameraNews& news : camera.news()) all.push_back(news.state);
  return all;
}

TEST(LiveCamera, TimeIsTheDriversSinceTheEpoch) {
  FakeCamera fake;
  fake.stamp_offset = -0.02;
  fake.plan_frames(3);
  LiveCamera camera(fake, fake.path, small());
  const std::vector<Frame> frames = grab_all(camera, fake);
  ASSERT_EQ(frames.size(), 3U);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(frames[static_cast<std::size_t>(k)].t, FakeCamera::kEpoch + 100 + 0.05 * (k + 1) - 0.02, 2e-6);
  EXPECT_THAT(camera.description(), testing::Not(HasSubstr("arrival")));
}

TEST(LiveCamera, TimesThatCannotBeTrueAreThoseOfArrival) {
  for (const bool is_monotonic : {false, true})
    for (const double offset : {-1e9, 0.5, -50.}) {
      SCOPED_TRACE(offset);
      FakeCamera fake;
      if (!is_monotonic) fake.stamp_flags = 0;
      fake.stamp_offset = offset;
      fake.plan_frames(3);
      LiveCamera camera(fake, fake.path, small());
      const std::vector<Frame> frames = grab_all(camera, fake);
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(frames[static_cast<std::size_t>(k)].t, FakeCamera::kEpoch + 100 + 0.05 * (k + 1), 1e-6);
      EXPECT_THAT(camera.description(), HasSubstr("times of arrival"));
    }
}

TEST(LiveCamera, GapsAndBrokenFramesAreCountedAndKeepTheirNumbers) {
  FakeCamera fake;
  fake.plan_frames(2);
  fake.plan(Kind::lost, 3);
  fake.plan_frames(1);
  fake.plan(Kind::marked_broken);
  fake.plan(Kind::wrong_size, 32 * 24 * 2 - 1);
  fake.plan(Kind::wrong_size, 32 * 24 * 2 + 1);
  fake.plan(Kind::wrong_size, 0);
  fake.plan_frames(1);
  LiveCamera camera(fake, fake.path, small());
  EXPECT_THAT(indices(grab_all(camera, fake)), ElementsAre(0, 1, 5, 10));
  EXPECT_EQ(camera.counts().lost, 3);
  EXPECT_EQ(camera.counts().broken, 4);
  EXPECT_THAT(states(camera), ElementsAre());
  EXPECT_EQ(fake.dequeued, fake.requeued);
}

TEST(LiveCamera, NothingReadyAndSignalsAreNoTrouble) {
  FakeCamera fake;
  for (int k = 0; k < 3; ++k) {
    fake.plan(Kind::again);
    fake.plan(Kind::signal);
    fake.plan(Kind::silence, 0, .9);
    fake.plan_frames(1);
  }
  LiveCamera camera(fake, fake.path, small());
  EXPECT_THAT(indices(grab_all(camera, fake)), ElementsAre(0, 1, 2));
  EXPECT_THAT(states(camera), ElementsAre());
}

TEST(LiveCamera, ASleepOfTheProgramIsNoStall) {
  FakeCamera fake;
  for (int k = 0; k < 3; ++k) {
    fake.plan_frames(2);
    fake.plan(Kind::asleep, 0, 30);
  }
  fake.plan_frames(1);
  LiveCamera camera(fake, fake.path, small());
  EXPECT_EQ(grab_all(camera, fake, 200).size(), 7U);
  EXPECT_THAT(states(camera), ElementsAre());
}

TEST(LiveCamera, AStalledCameraIsStartedAgain) {
  FakeCamera fake;
  fake.plan_frames(2);
  fake.plan(Kind::until_restart);
  fake.plan_frames(2);
  LiveCamera camera(fake, fake.path, small());
  EXPECT_THAT(indices(grab_all(camera, fake)), ElementsAre(0, 1, 2, 3));
  const std::vector<CameraNews> news = camera.news();
  ASSERT_EQ(news.size(), 2U);
  EXPECT_EQ(news[0].text, "/dev/video3 (Fake Cam) has sent no whole frame for 1.2 s, it is started again");
  EXPECT_THAT(news[1].text, HasSubstr("delivers frames again after 1.2 s"));
  EXPECT_EQ(fake.starts, 2);
  EXPECT_EQ(camera.counts().stalls, 1);
}

TEST(LiveCamera, WhatStartingAgainDoesNotHealIsOpenedAgain) {
  FakeCamera fake;
  fake.plan_frames(1);
  for (int k = 0; k < 4; ++k) fake.plan(Kind::until_restart);
  fake.plan_frames(1);
  LiveCamera camera(fake, fake.path, small());
  EXPECT_THAT(indices(grab_all(camera, fake)), ElementsAre(0, 1));
  EXPECT_EQ(fake.opened, 2);
  EXPECT_EQ(fake.starts, 5);
  EXPECT_THAT(states(camera), ElementsAre(CameraState::stalled, CameraState::streaming));
}

TEST(LiveCamera, ACameraOfBrokenFramesIsStalled) {
  FakeCamera fake;
  fake.plan_frames(1);
  for (int k = 0; k < 25; ++k) fake.plan(Kind::marked_broken);
  fake.plan_frames(1);
  LiveCamera camera(fake, fake.path, small());
  EXPECT_THAT(indices(grab_all(camera, fake)), ElementsAre(0, 26));
  EXPECT_THAT(states(camera), ElementsAre(CameraState::stalled, CameraState::streaming));
}

TEST(LiveCamera, FailedReadingIsAStall) {
  FakeCamera fake;
  fake.plan_frames(30);
  fake.plan(Kind::fails, EIO);
  fake.plan_frames(2);
  LiveCamera camera(fake, fake.path, small());
  EXPECT_EQ(grab_all(camera, fake).size(), 32U);
  const std::vector<CameraNews> news = camera.news();
  ASSERT_EQ(news.size(), 2U);
  EXPECT_THAT(news[0].text, HasSubstr("cannot be read: input/output error"));
}

TEST(LiveCamera, SurvivesBeingPulledOutAndComingBack) {
  for (const int opening_fails : {0, EACCES, EBUSY}) {
    SCOPED_TRACE(opening_fails);
    FakeCamera fake;
    fake.controls = {{V4L2_CID_AUTOGAIN, {0, 1, 1}}, {V4L2_CID_GAIN, {0, 100, 32}}};
    fake.plan_frames(2);
    fake.plan(Kind::unplug, opening_fails, 5);
    fake.plan_frames(2);
    LiveCamera camera(fake, fake.path, small());
    fake.controls.at(V4L2_CID_AUTOGAIN).value = 1;  // as a camera wakes up
    const std::vector<Frame> frames = grab_all(camera, fake);
    EXPECT_THAT(indices(frames), ElementsAre(0, 1, 2, 3));
    EXPECT_GT(frames[2].t, frames[1].t + 4.9);
    EXPECT_EQ(fake.controls.at(V4L2_CID_AUTOGAIN).value, 0);
    const std::vector<CameraNews> news = camera.news();
    ASSERT_EQ(news.size(), 2U);
    EXPECT_EQ(news[0].state, CameraState::unplugged);
    EXPECT_EQ(news[0].text, "/dev/video3 (Fake Cam) is unplugged, waiting for it");
    EXPECT_THAT(news[1].text, HasSubstr("is back after 5."));
    EXPECT_EQ(camera.counts().unplugged, 1);
    EXPECT_EQ(fake.faults, 0);
  }
}

TEST(LiveCamera, HeldFramesOutliveTheCamera) {
  FakeCamera fake;
  fake.plan_frames(1);
  fake.plan(Kind::unplug, 0, 1);
  fake.plan_frames(1);
  std::vector<Frame> frames;
  {
    LiveCamera camera(fake, fake.path, small());
    frames = grab_all(camera, fake);
  }
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].view.y(31, 23), 0);
  EXPECT_EQ(frames[1].view.y(31, 23), 1);
  EXPECT_EQ(fake.opened, fake.closed) << "a device that is held comes back under another name";
  EXPECT_GT(fake.mapped, fake.unmapped);
  frames.clear();
  EXPECT_EQ(fake.mapped, fake.unmapped);
  EXPECT_EQ(fake.faults, 0);
}

TEST(LiveCamera, AnotherPictureThanBeforeIsAnError) {
  FakeCamera fake;
  fake.plan_frames(1);
  fake.plan(Kind::unplug, 0, 1);
  fake.plan_frames(1);
  LiveCamera camera(fake, fake.path, small());
  fake.formats_when_back = {{V4L2_PIX_FMT_YUYV, {{64, 48}}, 20}};
  try {
    grab_all(camera, fake);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("came back as 'Fake Cam' with yuyv 64x48"),
                                             HasSubstr("must be yuyv 32x24 px, limited range")));
  }
}

/// Frames are kept for a random while; the driver must neither starve nor write into them.
TEST(LiveCamera, BuffersGoBackOnceAndAreNotTouchedWhileHeld) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    FakeCamera fake;
    fake.most_buffers = 2 + seed % 6;
    const auto any = [&](int limit) { return static_cast<int>(random() % static_cast<unsigned>(limit)); };
    for (int k = 0; k < 300; ++k) fake.plan(any(8) == 0 ? Kind::marked_broken : Kind::frame);
    LiveCamera camera(fake, fake.path, small());
    std::vector<std::pair<Frame, std::uint8_t>> kept;
    for (int looks = 0; looks < 1000 && !fake.steps.empty(); ++looks) {
      if (auto grabbed = camera.grab(100)) {
        const std::uint8_t value = grabbed->frame.view.y(0, 0);
        kept.emplace_back(std::move(grabbed->frame), value);
      }
      while (!kept.empty() && (kept.size() > 12 || any(3) == 0))
        kept.erase(kept.begin() + any(static_cast<int>(kept.size())));
      for (const auto& [frame, value] : kept) ASSERT_EQ(frame.view.y(31, 23), value);
      ASSERT_GE(fake.queued(), std::min<std::size_t>(2, fake.most_buffers));
    }
    EXPECT_TRUE(fake.steps.empty());
    kept.clear();
    EXPECT_EQ(fake.dequeued, fake.requeued);
    EXPECT_EQ(fake.faults, 0);
    EXPECT_THAT(states(camera), ElementsAre());
  }
}

SourceOptions source_of(const FakeCamera& fake) {
  SourceOptions options;
  options.location = "v4l2:" + fake.path;
  options.camera = small();
  return options;
}

TEST(CameraSource, GivesTheNewestFrameAndCountsTheOthers) {
  FakeCamera fake;
  fake.plan_frames(200);
  SourceOptions options = source_of(fake);
  std::vector<CameraState> told;
  bool over = false;
  options.interrupted = [&] { return over; };
  options.camera_news = [&](const CameraNews& news) {
    told.push_back(news.state);
    over = news.state == CameraState::stalled;  // the steps are used up
  };
  FrameSource source(make_camera_reader(options, fake));
  EXPECT_EQ(source.info().name, "/dev/video3");
  EXPECT_TRUE(source.info().live);
  EXPECT_EQ(source.info().width, 32);
  std::int64_t frames = 0, last = -1;
  while (const auto frame = source.next()) {
    EXPECT_GT(frame->index, last);
    last = frame->index;
    ++frames;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_EQ(last, 199) << "the newest is never lost";
  EXPECT_EQ(frames + source.camera_counts().replaced, 200);
  EXPECT_GT(source.camera_counts().replaced, 0);
  EXPECT_THAT(told, ElementsAre(CameraState::stalled));
}

TEST(CameraSource, JpegsAreDecodedAndDamagedOnesCounted) {
  const std::string file = testing::TempDir() + "tassilo_camera_frame.mjpeg";
  const TestClip clip{.path = file, .encoder = "mjpeg", .format = AV_PIX_FMT_YUVJ422P, .width = 32, .height = 24};
  write_clip(clip, {noise_picture(clip, 1)}, {0});
  for (const bool damaged : {false, true}) {
    FakeCamera fake;
    fake.formats = {{V4L2_PIX_FMT_MJPEG, {{32, 24}}, 20}};
    fake.jpeg = read_bytes(file);
    if (damaged) fake.jpeg.resize(fake.jpeg.size() / 2);
    fake.plan_frames(damaged ? 5 : 1);
    SourceOptions options = source_of(fake);
    bool over = false;
    options.interrupted = [&] { return over; };
    options.camera_news = [&](const CameraNews&) { over = true; };
    const auto reader = make_camera_reader(options, fake);
    const auto frame = reader->next();
    EXPECT_EQ(frame.has_value(), !damaged);
    EXPECT_EQ(reader->counts().broken + reader->counts().replaced, damaged ? 5 : 0);
    if (!frame) continue;
    EXPECT_EQ(frame->view.format(), PixelFormat::yuv422p);
    EXPECT_EQ(frame->range, ColorRange::full);
    EXPECT_NEAR(frame->t, FakeCamera::kEpoch + 100.05, 1e-5);
  }
}

TEST(CameraSource, AnErrorWhileGrabbingReachesTheReader) {
  FakeCamera fake;
  fake.plan_frames(1);
  fake.plan(Kind::unplug, 0, 1);
  fake.plan_frames(1);
  SourceOptions options = source_of(fake);
  fake.formats_when_back = {{V4L2_PIX_FMT_YUYV, {{64, 48}}, 20}};
  const auto reader = make_camera_reader(options, fake);
  EXPECT_THROW(while (reader->next()){}, Error);
}

TEST(CameraSource, RawFramesAndMissingCamerasAreRefused) {
  SourceOptions options;
  options.location = "/dev/video_none";
  EXPECT_THROW(open_source(options), Error);
  options.raw = RawFormat{.width = 8, .height = 8, .fps = 1};
  EXPECT_THROW(open_source(options), Error);
}

}  // namespace
}  // namespace tassilo
