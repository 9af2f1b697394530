#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/files/frames_file.h"
#include "tassilo/record/lossless_video.h"
#include "tassilo/source/frame_source.h"

// What is recorded and read again is what was seen: record writes, source reads, and neither knows the other.

namespace tassilo {
namespace {

namespace fs = std::filesystem;

class Lossless : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("tassilo_lossless_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  fs::path folder_;
};

Frame noise(PixelFormat format, int width, int height, ColorRange range, unsigned seed) {
  FrameBuffer buffer = make_frame_buffer(format, width, height, range);
  std::mt19937 random(seed);
  const bool halved = format == PixelFormat::yuv420p || format == PixelFormat::nv12;
  for (std::size_t p = 0; p < 3; ++p) {
    const int rows = p == 0 || !halved ? height : (height + 1) / 2;
    for (std::ptrdiff_t i = 0; i < buffer.strides[p] * rows; ++i)
      buffer.planes[p][i] = static_cast<std::uint8_t>(random());
  }
  return std::move(buffer.frame);
}

void expect_same(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.t, b.t) << "to the last bit";
  EXPECT_EQ(a.image, b.image);
  EXPECT_EQ(a.range, b.range);
  ASSERT_EQ(a.view.width(), b.view.width());
  ASSERT_EQ(a.view.height(), b.view.height());
  int different = 0;
  for (int r = 0; r < a.view.height(); ++r)
    for (int c = 0; c < a.view.width(); ++c)
      different +=
          a.view.y(c, r) != b.view.y(c, r) || a.view.u(c, r) != b.view.u(c, r) || a.view.v(c, r) != b.view.v(c, r);
  EXPECT_EQ(different, 0);
}

std::vector<Frame> read_all(const std::string& video) {
  FrameSource source = open_source({.location = video});
  std::vector<Frame> frames;
  while (auto frame = source.next()) frames.push_back(std::move(*frame));
  return frames;
}

const std::vector<PixelFormat> kFormats{PixelFormat::yuyv422, PixelFormat::uyvy422, PixelFormat::yuv422p,
                                        PixelFormat::yuv420p, PixelFormat::nv12};
// Of a camera: since the epoch, no whole milliseconds, some of them nearer than Matroska can tell; and lost frames.
const std::vector<double> kTimes{1.7e9 + 0.1234567, 1.7e9 + 0.1237, 1.7e9 + 0.1567891, 1.7e9 + 9.25, 1.7e9 + 9.2833331};
const std::vector<std::int64_t> kIndices{3, 4, 5, 17, 18};

TEST_F(Lossless, FramesComeBackToTheLastBitWhateverTheirFormat) {
  for (const PixelFormat format : kFormats)
    for (const ColorRange range : {ColorRange::limited, ColorRange::full})
      for (const auto& [width, height] : {std::pair{64, 48}, {66, 34}, {33, 17}, {2, 2}, {1, 1}}) {
        SCOPED_TRACE(std::string(to_string(format)) + " " + std::string(to_string(range)) + " " +
                     std::to_string(width));
        std::vector<Frame> given;
        LosslessVideo video(path("a.mkv"));
        for (std::size_t k = 0; k < kTimes.size(); ++k) {
          Frame& frame = given.emplace_back(noise(format, width, height, range, static_cast<unsigned>(k)));
          frame.index = kIndices[k];
          frame.t = kTimes[k];
          if (k == 2) frame.image = "b \"c\".png";
          video.write(frame);
        }
        video.finish();
        EXPECT_EQ(video.bytes(), static_cast<std::int64_t>(fs::file_size(path("a.mkv")) +
                                                           fs::file_size(stamps_file_of(path("a.mkv")))));
        const std::vector<Frame> read = read_all(path("a.mkv"));
        ASSERT_EQ(read.size(), given.size());
        const bool is_420 = format == PixelFormat::yuv420p || format == PixelFormat::nv12;
        for (std::size_t k = 0; k < read.size(); ++k) {
          expect_same(given[k], read[k]);
          EXPECT_EQ(read[k].view.format(), is_420 ? PixelFormat::yuv420p : PixelFormat::yuv422p);
        }
      }
}

// The writer is not finished, as after a crash: all frames given so far are there.
TEST_F(Lossless, WhatWasWrittenIsThereBeforeTheEnd) {
  LosslessVideo video(path("a.mkv"));
  for (std::size_t k = 0; k < kTimes.size(); ++k) {
    Frame frame = noise(PixelFormat::yuyv422, 64, 48, ColorRange::limited, static_cast<unsigned>(k));
    frame.index = kIndices[k];
    frame.t = kTimes[k];
    video.write(frame);
    fs::copy(path("a.mkv"), path("b.mkv"), fs::copy_options::overwrite_existing);
    fs::copy(stamps_file_of(path("a.mkv")), stamps_file_of(path("b.mkv")), fs::copy_options::overwrite_existing);
    const std::vector<Frame> read = read_all(path("b.mkv"));
    ASSERT_EQ(read.size(), k + 1);
    expect_same(frame, read.back());
  }
}

TEST_F(Lossless, OneFrameIsAVideo) {
  for (const double gap : {0.001, 0.1, 100.}) {
    SCOPED_TRACE(gap);
    for (int count = 1; count <= 3; ++count) {
      LosslessVideo video(path("a.mkv"));
      for (int k = 0; k < count; ++k) {
        Frame frame = noise(PixelFormat::yuyv422, 64, 48, ColorRange::limited, 1);
        frame.index = k;
        frame.t = 7 + gap * k;
        video.write(frame);
      }
      video.finish();
      EXPECT_EQ(read_all(path("a.mkv")).size(), static_cast<std::size_t>(count));
    }
  }
}

// A cut anywhere: whole frames before it, then an error or the end, never another picture.
TEST_F(Lossless, CutAnywhereTheFramesBeforeAreWhole) {
  std::vector<Frame> given;
  {
    LosslessVideo video(path("a.mkv"));
    for (std::size_t k = 0; k < kTimes.size(); ++k) {
      given.push_back(noise(PixelFormat::yuv420p, 64, 48, ColorRange::full, static_cast<unsigned>(k)));
      given.back().index = kIndices[k];
      given.back().t = kTimes[k];
      video.write(given.back());
    }
    fs::copy(path("a.mkv"), path("unfinished.mkv"));
  }
  std::ifstream file(path("unfinished.mkv"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  fs::copy(stamps_file_of(path("a.mkv")), stamps_file_of(path("cut.mkv")));
  std::size_t most = 0;
  for (std::size_t size = 1; size < bytes.size(); size += 997) {
    SCOPED_TRACE(size);
    std::ofstream(path("cut.mkv"), std::ios::binary) << bytes.substr(0, size);
    std::size_t count = 0;
    try {
      FrameSource source = open_source({.location = path("cut.mkv")});
      while (auto frame = source.next()) expect_same(given.at(count++), *frame);
    } catch (const Error&) {
    }
    EXPECT_GE(count, most) << "more bytes, no fewer frames";
    most = count;
  }
  EXPECT_GE(most, given.size() - 1);
}

TEST_F(Lossless, StampsThatDoNotFitAreNamed) {
  {
    LosslessVideo video(path("a.mkv"));
    for (int k = 0; k < 3; ++k) {
      Frame frame = noise(PixelFormat::yuv422p, 16, 12, ColorRange::limited, 1);
      frame.index = k;
      frame.t = k;
      video.write(frame);
    }
  }
  const std::string stamps = stamps_file_of(path("a.mkv")).string();
  const auto message = [&](const std::string& content) -> std::string {
    std::ofstream(stamps) << content;
    try {
      read_all(path("a.mkv"));
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(message("{\"frame\": 0, \"t\": 0}\n{\"frame\": 1, \"t\": 0.5}\n"),
            stamps + ": has no line for frame 2 of the video, must have one for each");
  EXPECT_THAT(message("{\"frame\": 0, \"t\": 0}\n{\"frame\": -1, \"t\": 0.5}\n"), testing::HasSubstr(stamps + ":2"));
  EXPECT_THAT(message("{\"frame\": 0}\n"), testing::HasSubstr(stamps + ":1"));
  EXPECT_THAT(message("x"), testing::HasSubstr(stamps + ":1"));
}

TEST_F(Lossless, ErrorsNameTheTarget) {
  const auto message = [](const std::function<void()>& action) -> std::string {
    try {
      action();
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  };
  EXPECT_THAT(message([&] { LosslessVideo video(path("a.mp4")); }), testing::HasSubstr("must end in .mkv"));
  EXPECT_THAT(message([&] { LosslessVideo video(path("no/a.mkv")); }), testing::HasSubstr("is no folder"));
  LosslessVideo video(path("a.mkv"));
  video.write(noise(PixelFormat::yuyv422, 16, 12, ColorRange::limited, 1));
  EXPECT_THAT(message([&] { video.write(noise(PixelFormat::nv12, 16, 12, ColorRange::limited, 1)); }),
              testing::HasSubstr("is 16x12 4:2:0 limited range, must be 16x12 4:2:2 limited range like the first"));
}

}  // namespace
}  // namespace tassilo
