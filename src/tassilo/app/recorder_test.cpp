#include "tassilo/app/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <random>

#include "tassilo/app/recent_median.h"
#include "tassilo/app/recorded_configuration.h"
#include "tassilo/base/error.h"
#include "tassilo/files/colors_file.h"
#include "tassilo/files/field_file.h"
#include "tassilo/files/frames_file.h"
#include "tassilo/source/frame_source.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

class RecorderTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / ("tassilo_" + std::string(test->name()) + std::to_string(getpid()));
    fs::create_directories(folder_);
    ColorTable table;
    table.brightness[static_cast<std::size_t>(class_index(ColorClass::green))] = {30, 200};
    write_colors(folder_ / "colors.yaml", {table, std::nullopt});
    configuration_ = loaded({});
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::shared_ptr<const Configuration> loaded(const std::function<void(RobotSetup&)>& change) const {
    return load_configuration(
        "", (folder_ / "colors.yaml").string(), {}, change ? change : [](RobotSetup&) {});
  }
  static Frame frame_of(int index, int width, int height) {
    FrameBuffer buffer = make_frame_buffer(PixelFormat::yuyv422, width, height, ColorRange::limited);
    std::mt19937 random(static_cast<unsigned>(index));
    for (std::ptrdiff_t i = 0; i < buffer.strides[0] * height; i += 4)
      *reinterpret_cast<std::uint32_t*>(buffer.planes[0] + i) = static_cast<std::uint32_t>(random());
    buffer.frame.index = index;
    buffer.frame.t = 0.1 * index;
    return std::move(buffer.frame);
  }
  void see(Recorder& recorder, const Frame& frame) {
    recorder.before(frame, configuration_, history_, odometry_);
    Scene scene;
    scene.frame = frame.index;
    scene.t = frame.t;
    scene.timing.push_back({"total", 1});
    recorder.after(frame, scene, odometry_);
  }
  /// The indices of the frames in each part, as a source reads them.
  std::vector<std::vector<std::int64_t>> parts() const {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(folder_ / "recordings")) paths.push_back(entry.path());
    std::ranges::sort(paths);
    std::vector<std::vector<std::int64_t>> all;
    for (const fs::path& path : paths) {
      FrameSource source = open_source({.location = (path / "video.mkv").string()});
      all.emplace_back();
      while (const auto frame = source.next()) all.back().push_back(frame->index);
    }
    return all;
  }

  fs::path folder_;
  std::shared_ptr<const Configuration> configuration_;
  VisionHistory history_;
  OdometryInput odometry_{"", false};
};

// Frames that come faster than any disk: what waits is bounded, what does not fit is counted, no part has a gap.
TEST_F(RecorderTest, WhatDoesNotFitIsCountedAndEndsThePart) {
  constexpr int kWidth = 2000, kHeight = 1500, kFrames = 60;
  constexpr std::int64_t kBytes = 2 * kWidth * kHeight;
  const Frame pixels = frame_of(1, kWidth, kHeight);
  Recorder recorder(folder_ / "recordings", false);
  recorder.start();
  std::int64_t most = 0;
  for (int k = 0; k < kFrames; ++k) {
    Frame frame = pixels;
    frame.index = k;
    frame.t = 0.1 * k;
    see(recorder, frame);
    const RecordingState state = recorder.state();
    most = std::max(most, k + 1 - state.frames - state.dropped);
    const auto waiting = [&] { return (k + 1 - recorder.state().frames - recorder.state().dropped) * kBytes; };
    while (k == kFrames / 2 && waiting() > Recorder::kMaxWaiting / 4)  // it catches up
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  recorder.finish();
  const RecordingState state = recorder.state();
  EXPECT_EQ(state.trouble, "");
  EXPECT_FALSE(state.on || state.finishing);
  EXPECT_GT(state.dropped, 0);
  EXPECT_EQ(state.frames + state.dropped, kFrames);
  EXPECT_LE(most * kBytes, Recorder::kMaxWaiting);
  EXPECT_GT(state.parts, 1);
  const auto recorded = parts();
  ASSERT_EQ(recorded.size(), static_cast<std::size_t>(state.parts));
  std::int64_t count = 0;
  for (const auto& part : recorded) {
    count += static_cast<std::int64_t>(part.size());
    EXPECT_EQ(part.back() - part.front() + 1, static_cast<std::int64_t>(part.size()));
  }
  EXPECT_EQ(count, state.frames);
}

TEST_F(RecorderTest, ASourceThatLosesNothingIsMadeToWait) {
  const Frame pixels = frame_of(1, 2000, 1500);
  Recorder recorder(folder_ / "recordings", true);
  recorder.start();
  for (int k = 0; k < 30; ++k) {
    Frame frame = pixels;
    frame.index = k;
    frame.t = 0.1 * k;
    see(recorder, frame);
  }
  recorder.finish();
  EXPECT_EQ(recorder.state().frames, 30);
  EXPECT_EQ(recorder.state().dropped, 0);
  EXPECT_EQ(parts().size(), 1u);
}

TEST_F(RecorderTest, APartForEachConfigurationAndEachDrive) {
  Recorder recorder(folder_ / "recordings", true);
  see(recorder, frame_of(0, 32, 24));
  recorder.start();
  for (int k = 1; k < 4; ++k) see(recorder, frame_of(k, 32, 24));
  configuration_ = loaded({});
  for (int k = 4; k < 6; ++k) see(recorder, frame_of(k, 32, 24));
  for (int k = 0; k < 2; ++k) see(recorder, frame_of(k, 32, 24));  // the source begins again
  recorder.stop();
  see(recorder, frame_of(2, 32, 24));
  recorder.start();
  recorder.stop();  // without a frame: nothing
  recorder.start();
  see(recorder, frame_of(3, 32, 24));
  recorder.finish();
  EXPECT_THROW(recorder.start(), Error);
  using List = std::vector<std::int64_t>;
  EXPECT_THAT(parts(), testing::UnorderedElementsAre(List{1, 2, 3}, List{4, 5}, List{0, 1}, List{3}));
  EXPECT_EQ(recorder.state().frames, 1);
}

TEST_F(RecorderTest, TroubleEndsItAndItCanBeBegunAgain) {
  Recorder recorder(folder_ / "recordings", true);
  recorder.start();
  see(recorder, frame_of(0, 32, 24));
  see(recorder, frame_of(1, 64, 24));  // no disk is needed to fail: a video has one size
  see(recorder, frame_of(2, 64, 24));
  while (recorder.state().on) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_THAT(recorder.state().trouble, testing::HasSubstr("frame 1 is 64x24"));
  see(recorder, frame_of(3, 64, 24));
  recorder.start();
  EXPECT_EQ(recorder.state().trouble, "");
  see(recorder, frame_of(4, 64, 24));
  recorder.finish();
  EXPECT_EQ(recorder.state().frames, 1);
  using List = std::vector<std::int64_t>;
  EXPECT_THAT(parts(), testing::UnorderedElementsAre(List{0}, List{4}));
}

// What was loaded, whatever the files say now.
TEST_F(RecorderTest, TheConfigurationIsTheOneAtWork) {
  std::ofstream(folder_ / "robot.yaml")
      << "{robot: {id: 9}, colors: colors.yaml, field: rcj_soccer, "
         "start_pose: {x: .1, y: -.2, theta: 0.3, sigma_xy: 0.07}, vision: {ball_max: 4}}";
  const auto configuration = load_configuration((folder_ / "robot.yaml").string(), "", {}, [](RobotSetup&) {});
  std::ofstream(folder_ / "robot.yaml") << "nothing of it";
  fs::remove(folder_ / "colors.yaml");
  fs::create_directories(folder_ / "written");
  write_configuration(folder_ / "written", *configuration, std::nullopt, "# a remark\n");
  const RobotSetup read = read_robot_setup((folder_ / "written/robot.yaml").string(), "");
  const RobotSetup& given = configuration->setup;
  EXPECT_EQ(read.robot.id, 9);
  EXPECT_EQ(read.vision.colors, given.vision.colors);
  FieldModel field = read.vision.field;
  field.name = given.vision.field.name;
  EXPECT_EQ(field, given.vision.field);
  EXPECT_EQ(option_values(read.vision.options), option_values(given.vision.options));
  ASSERT_TRUE(read.vision.start_pose);
  EXPECT_EQ(read.vision.start_pose->x, given.vision.start_pose->x);
  EXPECT_EQ(read.vision.start_pose->covariance, given.vision.start_pose->covariance);
}

TEST(RecentMedian, IsThatOfTheLastSecond) {
  using std::chrono::milliseconds;
  RecentMedian median;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(median.get(start));
  for (int k = 0; k < 30; ++k) median.add(k == 7 ? 1000 : k, start + milliseconds(33 * k));
  EXPECT_NEAR(*median.get(start + milliseconds(960)), 14, 1);
  median.add(500, start + milliseconds(1900));
  EXPECT_EQ(*median.get(start + milliseconds(2800)), 500);
  EXPECT_FALSE(median.get(start + milliseconds(2901)));
  for (int k = 0; k < 5000; ++k) median.add(k, start + milliseconds(3000));
  EXPECT_NEAR(*median.get(start + milliseconds(3000)), 4500, 1);
}

}  // namespace
}  // namespace tassilo
