#include "tassilo/source/frame_source.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "tassilo/source/internal/container_size.h"
#include "tassilo/source/test_clip.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A folder of its own for each test, gone afterwards.
class FrameSourceTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / ("tassilo_source_" + std::string(test->name()) + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  fs::path folder_;
};

/// All samples of a frame: Y, then U, then V, planes without padding, chroma rows as stored.
PictureBytes samples_of(const Frame& frame) {
  const FrameView& view = frame.view;
  const bool halved_rows = view.format() == PixelFormat::yuv420p || view.format() == PixelFormat::nv12;
  const int step = halved_rows ? 2 : 1;
  PictureBytes bytes;
  for (int r = 0; r < view.height(); ++r)
    for (int c = 0; c < view.width(); ++c) bytes.push_back(view.y(c, r));
  for (const bool is_u : {true, false})
    for (int r = 0; r < view.height(); r += step)
      for (int c = 0; c < view.width(); c += 2) bytes.push_back(is_u ? view.u(c, r) : view.v(c, r));
  return bytes;
}

struct ReadResult {
  std::vector<Frame> frames;
  std::string error;  ///< Empty: came to the end.
};

ReadResult read_all(const SourceOptions& options) {
  ReadResult result;
  try {
    FrameSource source = open_source(options);
    while (auto frame = source.next()) result.frames.push_back(std::move(*frame));
    EXPECT_FALSE(source.next()) << "the end stays the end";
  } catch (const Error& error) {
    result.error = error.what();
  }
  return result;
}

ReadResult read_all(const std::string& location) { return read_all(SourceOptions{.location = location}); }

/// While alive, standard input is a file.
class StandardInput {
 public:
  explicit StandardInput(const std::string& file) : saved_(::dup(STDIN_FILENO)) {
    const int fd = ::open(file.c_str(), O_RDONLY);
    ::dup2(fd, STDIN_FILENO);
    ::close(fd);
  }
  ~StandardInput() {
    ::dup2(saved_, STDIN_FILENO);
    ::close(saved_);
  }

 private:
  int saved_;
};

constexpr PixelFormat kFormats[] = {PixelFormat::yuyv422, PixelFormat::uyvy422, PixelFormat::yuv422p,
                                    PixelFormat::yuv420p, PixelFormat::nv12};

std::size_t raw_frame_size(const RawFormat& raw) {
  const std::size_t pairs = static_cast<std::size_t>(raw.width + 1) / 2;
  const auto rows = static_cast<std::size_t>(raw.height);
  switch (raw.format) {
    case PixelFormat::yuyv422:
    case PixelFormat::uyvy422:
      return 4 * pairs * rows;
    case PixelFormat::yuv422p:
      return (static_cast<std::size_t>(raw.width) + 2 * pairs) * rows;
    default:
      return static_cast<std::size_t>(raw.width) * rows + 2 * pairs * ((rows + 1) / 2);
  }
}

std::string noise(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  std::string bytes(size, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  return bytes;
}

// The bytes of a raw frame, addressed by hand.
TEST_F(FrameSourceTest, RawFramesAreTheBytesOfTheFile) {
  for (const PixelFormat format : kFormats)
    for (const auto& [width, height] : {std::pair{8, 6}, {7, 5}, {1, 1}}) {
      SCOPED_TRACE(std::string(to_string(format)) + " " + std::to_string(width) + "x" + std::to_string(height));
      const RawFormat raw{format, width, height, ColorRange::full, 20};
      const std::size_t size = raw_frame_size(raw);
      const std::string bytes = noise(3 * size, 1);
      write_bytes(path("a.yuv"), bytes);
      FrameSource source = open_source({.location = path("a.yuv"), .raw = raw});
      EXPECT_EQ(source.info().frame_count, 3);
      EXPECT_EQ(source.info().range, ColorRange::full);
      for (int k = 0; k < 3; ++k) {
        const auto frame = source.next();
        ASSERT_TRUE(frame);
        EXPECT_EQ(frame->index, k);
        EXPECT_DOUBLE_EQ(frame->t, k / 20.0);
        const auto byte = [&](std::size_t i) {
          return static_cast<std::uint8_t>(bytes[static_cast<std::size_t>(k) * size + i]);
        };
        const FrameView& view = frame->view;
        const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height), pairs = (w + 1) / 2;
        for (int r = 0; r < height; ++r)
          for (int c = 0; c < width; ++c) {
            const auto row = static_cast<std::size_t>(r), col = static_cast<std::size_t>(c), pair = col / 2;
            std::size_t y = row * w + col, u = 0, v = 0;
            switch (format) {
              case PixelFormat::yuyv422:
                y = 4 * (row * pairs + pair) + 2 * (col % 2), u = 4 * (row * pairs + pair) + 1, v = u + 2;
                break;
              case PixelFormat::uyvy422:
                y = 4 * (row * pairs + pair) + 2 * (col % 2) + 1, u = 4 * (row * pairs + pair), v = u + 2;
                break;
              case PixelFormat::yuv422p:
                u = w * h + row * pairs + pair, v = u + pairs * h;
                break;
              case PixelFormat::yuv420p:
                u = w * h + row / 2 * pairs + pair, v = u + pairs * ((h + 1) / 2);
                break;
              case PixelFormat::nv12:
                u = w * h + 2 * (row / 2 * pairs + pair), v = u + 1;
                break;
            }
            ASSERT_EQ(view.y(c, r), byte(y));
            ASSERT_EQ(view.u(c, r), byte(u));
            ASSERT_EQ(view.v(c, r), byte(v));
          }
      }
      EXPECT_FALSE(source.next());
    }
}

TEST_F(FrameSourceTest, RawCutFrameIsNamedAfterTheWholeOnes) {
  const RawFormat raw{PixelFormat::nv12, 8, 6, ColorRange::limited, 10};
  const std::size_t size = raw_frame_size(raw);
  for (const bool through_stdin : {false, true})
    for (std::size_t extra = 1; extra < size; extra += 7) {
      SCOPED_TRACE(extra);
      write_bytes(path("a.yuv"), noise(2 * size + extra, 2));
      const StandardInput input(path("a.yuv"));
      const auto [frames, error] = read_all({.location = through_stdin ? "-" : path("a.yuv"), .raw = raw});
      EXPECT_EQ(frames.size(), 2u);
      EXPECT_EQ(error, (through_stdin ? "standard input" : path("a.yuv")) + ": frame 2 is cut short: " +
                           std::to_string(extra) + " bytes, must be " + std::to_string(size) + " (nv12 8x6)");
    }
}

TEST_F(FrameSourceTest, DamageIsToldEachTime) {
  const RawFormat raw{PixelFormat::nv12, 8, 6, ColorRange::limited, 10};
  write_bytes(path("a.yuv"), noise(raw_frame_size(raw) + 1, 2));
  FrameSource source = open_source({.location = path("a.yuv"), .raw = raw});
  EXPECT_TRUE(source.next());
  EXPECT_THROW(source.next(), Error);
  EXPECT_THROW(source.next(), Error);
}

TEST_F(FrameSourceTest, InterruptionIsAnEnd) {
  const RawFormat raw{PixelFormat::nv12, 8, 6, ColorRange::limited, 10};
  write_bytes(path("a.yuv"), noise(5 * raw_frame_size(raw), 2));
  bool stop = false;
  FrameSource source = open_source({.location = path("a.yuv"), .raw = raw, .interrupted = [&] { return stop; }});
  EXPECT_TRUE(source.next());
  EXPECT_TRUE(source.next());
  stop = true;
  EXPECT_FALSE(source.next());
}

// A lossless codec gives back every byte, in the codec's own layout, with its range and its time stamps.
TEST_F(FrameSourceTest, LosslessVideoIsExact) {
  const std::vector<std::int64_t> stamps{0, 50, 101, 149, 350, 351, 400};
  struct Case {
    AVPixelFormat av;
    PixelFormat ours;
    std::string file, encoder;
  };
  const Case cases[] = {{AV_PIX_FMT_YUV422P, PixelFormat::yuv422p, "a.mkv", "ffv1"},
                        {AV_PIX_FMT_YUV420P, PixelFormat::yuv420p, "b.mkv", "ffv1"},
                        {AV_PIX_FMT_YUYV422, PixelFormat::yuyv422, "c.mkv", "rawvideo"},
                        {AV_PIX_FMT_UYVY422, PixelFormat::uyvy422, "d.mkv", "rawvideo"},
                        {AV_PIX_FMT_NV12, PixelFormat::nv12, "e.nut", "rawvideo"}};
  for (const Case& c : cases)
    for (const AVColorRange range : {AVCOL_RANGE_UNSPECIFIED, AVCOL_RANGE_MPEG, AVCOL_RANGE_JPEG})
      for (const bool through_stdin : {false, true}) {
        SCOPED_TRACE(c.file + " range " + std::to_string(range) + (through_stdin ? " stdin" : ""));
        const TestClip clip{
            .path = path(c.file), .encoder = c.encoder, .format = c.av, .width = 34, .height = 18, .range = range};
        std::vector<PictureBytes> pictures;
        for (unsigned k = 0; k < stamps.size(); ++k) pictures.push_back(noise_picture(clip, k));
        write_clip(clip, pictures, stamps);
        const StandardInput input(clip.path);
        const auto [frames, error] = read_all(through_stdin ? "-" : clip.path);
        EXPECT_EQ(error, "");
        ASSERT_EQ(frames.size(), stamps.size());
        for (std::size_t k = 0; k < frames.size(); ++k) {
          const Frame& frame = frames[k];
          EXPECT_EQ(frame.view.format(), c.ours);
          EXPECT_EQ(frame.view.width(), 34);
          EXPECT_EQ(frame.view.height(), 18);
          if (range != AVCOL_RANGE_UNSPECIFIED && !c.file.ends_with("nut")) {
            EXPECT_EQ(frame.range, range == AVCOL_RANGE_JPEG ? ColorRange::full : ColorRange::limited);
          }
          EXPECT_EQ(frame.index, static_cast<std::int64_t>(k));
          EXPECT_EQ(frame.t, static_cast<double>(stamps[k]) / 1000) << "the nearest double, not one beside it";
          // Compare through the raw reader, whose addressing is tested by hand above.
          write_bytes(path("k.yuv"), std::string(pictures[k].begin(), pictures[k].end()));
          const Frame raw =
              read_frame({.location = path("k.yuv"), .raw = RawFormat{c.ours, 34, 18, ColorRange::full, 1}}, 0);
          EXPECT_EQ(samples_of(frame), samples_of(raw));
        }
      }
}

TEST_F(FrameSourceTest, UntaggedRangeIsLimitedButFullForJpeg) {
  const std::vector<std::int64_t> stamps{0};
  const TestClip ffv1{.path = path("a.mkv")};
  write_clip(ffv1, {noise_picture(ffv1, 0)}, stamps);
  EXPECT_EQ(open_source({.location = ffv1.path}).info().range, ColorRange::limited);
  for (const std::string file : {"b.avi", "b.mjpeg", "b.jpg"}) {
    SCOPED_TRACE(file);
    const TestClip jpeg{.path = path(file), .encoder = "mjpeg", .format = AV_PIX_FMT_YUVJ422P};
    write_clip(jpeg, {noise_picture(jpeg, 0)}, stamps);
    const FrameSource source = open_source({.location = jpeg.path});
    EXPECT_EQ(source.info().range, ColorRange::full);
    EXPECT_THAT(source.info().description, HasSubstr("yuvj422p 16x12 px, full range"));
  }
}

struct RgbPixel {
  double r, g, b;  ///< 0..1
};

/// The formulas of docs/conventions.md in plain floating point, before rounding: Y of `a`, Cb and Cr of the mean.
struct Yuv {
  double y, u, v;
};
Yuv bt601(RgbPixel a, RgbPixel mean, ColorRange range) {
  const auto luma = [](RgbPixel p) { return .299 * p.r + .587 * p.g + .114 * p.b; };
  const double pb = (mean.b - luma(mean)) / 1.772, pr = (mean.r - luma(mean)) / 1.402;
  if (range == ColorRange::full) return {255 * luma(a), 128 + 255 * pb, 128 + 255 * pr};
  return {16 + 219 * luma(a), 128 + 224 * pb, 128 + 224 * pr};
}

/// `got` is the rounded, clipped `exact`.
void expect_rounded(int got, double exact) { EXPECT_LE(std::abs(got - std::clamp(exact, 0.0, 255.0)), .5 + 1e-9); }

TEST_F(FrameSourceTest, RgbBecomesBt601InTheAskedRange) {
  struct Case {
    AVPixelFormat av;
    std::string file, encoder;
    int r, g, b, step;  ///< Places of the components in a pixel of `step` samples; step 1: planes in that order.
    double largest;
  };
  const Case cases[] = {{AV_PIX_FMT_RGB24, "a.png", "png", 0, 1, 2, 3, 255},
                        {AV_PIX_FMT_RGBA, "b.png", "png", 0, 1, 2, 4, 255},
                        {AV_PIX_FMT_GRAY8, "c.png", "png", 0, 0, 0, 1, 255},
                        {AV_PIX_FMT_BGR0, "d.mkv", "ffv1", 2, 1, 0, 4, 255},
                        {AV_PIX_FMT_GBRP, "e.mkv", "magicyuv", 2, 0, 1, 1, 255},
                        {AV_PIX_FMT_GBRP10LE, "f.mkv", "ffv1", 2, 0, 1, 1, 1023}};
  for (const Case& c : cases)
    for (const int width : {16, 15})
      for (const ColorRange range : {ColorRange::limited, ColorRange::full}) {
        SCOPED_TRACE(c.file + " width " + std::to_string(width) + " " + std::string(to_string(range)));
        const TestClip clip{.path = path(c.file), .encoder = c.encoder, .format = c.av, .width = width, .height = 8};
        const PictureBytes bytes = noise_picture(clip, 3);
        write_clip(clip, {bytes}, {0});
        const Frame frame = read_frame({.location = clip.path, .images_range = range}, 0);
        ASSERT_EQ(frame.range, range);
        ASSERT_EQ(frame.view.format(), PixelFormat::yuv422p);
        const auto sample = [&](int component, int col, int r) -> double {
          const int at = c.step == 1 ? component * width * 8 + r * width + col : (r * width + col) * c.step + component;
          const auto i = static_cast<std::size_t>(at);
          return c.largest > 255 ? (bytes[2 * i] + 256 * bytes[2 * i + 1]) / c.largest : bytes[i] / c.largest;
        };
        const auto pixel = [&](int col, int r) {
          return RgbPixel{sample(c.r, col, r), sample(c.g, col, r), sample(c.b, col, r)};
        };
        for (int r = 0; r < 8; ++r)
          for (int col = 0; col < width; ++col) {
            const RgbPixel a = pixel(col & ~1, r), b = pixel(std::min(col | 1, width - 1), r);
            const RgbPixel mean{(a.r + b.r) / 2, (a.g + b.g) / 2, (a.b + b.b) / 2};
            const Yuv exact = bt601(pixel(col, r), mean, range);
            expect_rounded(frame.view.y(col, r), exact.y);
            expect_rounded(frame.view.u(col, r), exact.u);
            expect_rounded(frame.view.v(col, r), exact.v);
          }
      }
}

// Other chroma layouts and depths: means over column pairs, rows kept, black and white stay black and white.
TEST_F(FrameSourceTest, OtherYuvKeepsItsRange) {
  struct Case {
    AVPixelFormat av;
    int depth, chroma_shift_w, chroma_shift_h;
  };
  const Case cases[] = {{AV_PIX_FMT_YUV444P, 8, 0, 0},      {AV_PIX_FMT_YUV440P, 8, 0, 1},
                        {AV_PIX_FMT_YUV411P, 8, 2, 0},      {AV_PIX_FMT_YUV422P10LE, 10, 1, 0},
                        {AV_PIX_FMT_YUV420P10LE, 10, 1, 1}, {AV_PIX_FMT_YUV444P12LE, 12, 0, 0}};
  for (const Case& c : cases)
    for (const AVColorRange range : {AVCOL_RANGE_MPEG, AVCOL_RANGE_JPEG}) {
      SCOPED_TRACE(std::to_string(c.av) + " range " + std::to_string(range));
      const bool full = range == AVCOL_RANGE_JPEG;
      const TestClip clip{.path = path("a.mkv"), .format = c.av, .width = 16, .height = 8, .range = range};
      const PictureBytes bytes = noise_picture(clip, 4);
      write_clip(clip, {bytes}, {0});
      const Frame frame = read_frame({.location = clip.path}, 0);
      ASSERT_EQ(frame.range, full ? ColorRange::full : ColorRange::limited);
      const int chroma_width = 16 >> c.chroma_shift_w, chroma_height = 8 >> c.chroma_shift_h;
      const auto sample = [&](int at) -> double {
        const auto i = static_cast<std::size_t>(at);
        return c.depth > 8 ? bytes[2 * i] + 256 * bytes[2 * i + 1] : bytes[i];
      };
      const double scale = full ? 255.0 / ((1 << c.depth) - 1) : 256.0 / (1 << c.depth);
      const double middle = 1 << (c.depth - 1);
      for (int r = 0; r < 8; ++r)
        for (int col = 0; col < 16; ++col) {
          expect_rounded(frame.view.y(col, r), scale * sample(r * 16 + col));
          for (const int plane : {0, 1}) {
            const auto chroma = [&](int column) {
              return sample(16 * 8 + plane * chroma_width * chroma_height + (r >> c.chroma_shift_h) * chroma_width +
                            (column >> c.chroma_shift_w));
            };
            const double mean = (chroma(col & ~1) + chroma(col | 1)) / 2;
            expect_rounded(plane == 0 ? frame.view.u(col, r) : frame.view.v(col, r), 128 + scale * (mean - middle));
          }
        }
    }
}

/// Writes 12 pictures, 50 ms apart, and returns what a whole read gives.
std::vector<PictureBytes> write_and_read(const TestClip& clip) {
  std::vector<PictureBytes> pictures;
  std::vector<std::int64_t> stamps;
  for (unsigned k = 0; k < 12; ++k) {
    pictures.push_back(noise_picture(clip, k));
    stamps.push_back(50 * k);
  }
  write_clip(clip, pictures, stamps);
  std::vector<PictureBytes> whole;
  const auto [frames, error] = read_all(clip.path);
  EXPECT_EQ(error, "");
  EXPECT_EQ(frames.size(), pictures.size());
  for (const Frame& frame : frames) whole.push_back(samples_of(frame));
  return whole;
}

// Wherever a file is cut: what is delivered is the beginning of the whole, and the loss is told with file and frame.
TEST_F(FrameSourceTest, CutFilesGiveTheFramesBeforeTheCut) {
  const TestClip clips[] = {
      {.path = path("a.mkv")},
      {.path = path("live.mkv"), .muxer_options = "live=1"},  // no sizes, as after a crash
      {.path = path("b.avi"), .encoder = "mjpeg", .format = AV_PIX_FMT_YUVJ422P},
      {.path = path("c.y4m"), .encoder = "wrapped_avframe"},
      {.path = path("d.mp4"), .encoder = "mpeg4", .format = AV_PIX_FMT_YUV420P, .muxer_options = "movflags=faststart"},
      {.path = path("e.mp4"), .encoder = "mpeg4", .format = AV_PIX_FMT_YUV420P, .b_frames = 2},
      {.path = path("f.mjpeg"), .encoder = "mjpeg", .format = AV_PIX_FMT_YUVJ420P}};
  for (const TestClip& clip : clips) {
    const std::vector<PictureBytes> whole = write_and_read(clip);
    const std::string bytes = read_bytes(clip.path);
    std::size_t most = 0;
    for (int cut = 0; cut < 60; ++cut) {
      const std::size_t size = bytes.size() * static_cast<std::size_t>(cut) / 60;
      SCOPED_TRACE(clip.path + " cut to " + std::to_string(size) + " of " + std::to_string(bytes.size()));
      write_bytes(clip.path, bytes.substr(0, size));
      const auto [frames, error] = read_all(clip.path);
      most = std::max(most, frames.size());
      ASSERT_LE(frames.size(), whole.size());
      for (std::size_t k = 0; k < frames.size(); ++k) EXPECT_EQ(samples_of(frames[k]), whole[k]);
      // One JPEG after the other, without a header: cut between two it is a whole file, only shorter.
      const bool is_shorter_stream = clip.path.ends_with(".mjpeg") && bytes.substr(0, size).ends_with("\xff\xd9");
      if (is_shorter_stream) continue;
      EXPECT_THAT(error, HasSubstr(clip.path));
      if (!frames.empty()) {
        EXPECT_THAT(error, HasSubstr("frame " + std::to_string(frames.size())));
      }
    }
    const bool index_at_end = clip.path.ends_with("e.mp4");
    EXPECT_GE(most, index_at_end ? 0u : 10u);
    write_bytes(clip.path, bytes.substr(0, bytes.size() - 1));
    EXPECT_NE(read_all(clip.path).error, "") << clip.path << " without its last byte";
  }
}

TEST_F(FrameSourceTest, WrongChecksumNamesTheFrame) {
  const TestClip clip{.path = path("a.mkv"), .width = 64, .height = 48};
  const std::vector<PictureBytes> whole = write_and_read(clip);
  const std::string bytes = read_bytes(clip.path);
  for (std::size_t at = bytes.size() / 4; at < bytes.size() * 3 / 4; at += bytes.size() / 37) {
    SCOPED_TRACE(at);
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    write_bytes(clip.path, damaged);
    const auto [frames, error] = read_all(clip.path);
    EXPECT_LT(frames.size(), whole.size());
    for (std::size_t k = 0; k < frames.size(); ++k) EXPECT_EQ(samples_of(frames[k]), whole[k]);
    EXPECT_THAT(error, HasSubstr(clip.path + ": frame " + std::to_string(frames.size()) + " is damaged"));
  }
}

// Reordered pictures come in capture order, and the last ones come out of the decoder too.
TEST_F(FrameSourceTest, BFramesAllComeInOrder) {
  const TestClip clip{.path = path("a.mp4"), .encoder = "mpeg4", .format = AV_PIX_FMT_YUV420P, .b_frames = 2};
  write_and_read(clip);
  const auto frames = read_all(clip.path).frames;
  ASSERT_EQ(frames.size(), 12u);
  for (std::size_t k = 0; k < frames.size(); ++k) EXPECT_DOUBLE_EQ(frames[k].t, .05 * static_cast<double>(k));
}

TEST_F(FrameSourceTest, ChangedSizeIsAnError) {
  TestClip clip{.path = path("a.mjpeg"), .encoder = "mjpeg", .format = AV_PIX_FMT_YUVJ420P};
  write_clip(clip, {noise_picture(clip, 0), noise_picture(clip, 1)}, {0, 50});
  const std::string small = read_bytes(clip.path);
  clip.width = 32;
  write_clip(clip, {noise_picture(clip, 0)}, {0});
  write_bytes(clip.path, small + read_bytes(clip.path));
  const auto [frames, error] = read_all(clip.path);
  EXPECT_EQ(frames.size(), 2u);
  EXPECT_EQ(error, clip.path + ": frame 2: is 32x12 px, must be 16x12 like the frames before");
}

void write_png(const std::string& path, unsigned seed) {
  const TestClip clip{.path = path, .encoder = "png", .format = AV_PIX_FMT_RGB24};
  write_clip(clip, {noise_picture(clip, seed)}, {0});
}

TEST_F(FrameSourceTest, FolderIsReadInNaturalOrder) {
  const std::vector<std::string> names{"a2.png", "a10.png", "b1.png", "b01.png", "b3x.JPG", "b20.jpeg"};
  for (unsigned k = 0; k < names.size(); ++k) write_png(path(names[k]), k);  // contents decide, not extensions
  write_bytes(path("notes.txt"), "no image");
  FrameSource source = open_source({.location = folder_.string()});
  EXPECT_EQ(source.info().frame_count, 6);
  std::vector<std::string> order;
  while (const auto frame = source.next()) {
    EXPECT_EQ(frame->index, static_cast<std::int64_t>(order.size()));
    EXPECT_DOUBLE_EQ(frame->t, static_cast<double>(order.size())) << "one a second";
    order.push_back(frame->image);
  }
  EXPECT_THAT(order, testing::ElementsAre("a2.png", "a10.png", "b01.png", "b1.png", "b3x.JPG", "b20.jpeg"));
  EXPECT_DOUBLE_EQ(read_frame({.location = folder_.string(), .fps = 4}, 3).t, .75);
}

TEST_F(FrameSourceTest, BrokenImageIsNamedAfterTheOnesBefore) {
  for (const std::string name : {"1.png", "2.png", "3.png"}) write_png(path(name), 1);
  const std::string png = read_bytes(path("2.png"));
  const TestClip jpeg{
      .path = path("a.jpg"), .encoder = "mjpeg", .format = AV_PIX_FMT_YUVJ420P, .width = 64, .height = 64};
  write_clip(jpeg, {noise_picture(jpeg, 0)}, {0});
  const std::string jpg = read_bytes(path("a.jpg"));
  std::string flipped = png;
  flipped[png.size() / 2] = static_cast<char>(flipped[png.size() / 2] ^ 1);
  const std::vector<std::string> broken{"",
                                        "x",
                                        "no image",
                                        png.substr(0, png.size() / 2),
                                        png.substr(0, png.size() - 9),
                                        flipped,
                                        jpg.substr(0, jpg.size() / 2),
                                        jpg.substr(0, jpg.size() / 2) + "\xff\xd9"};
  fs::remove(path("a.jpg"));
  for (std::size_t k = 0; k < broken.size(); ++k) {
    SCOPED_TRACE(k);
    write_bytes(path("2.png"), broken[k]);
    const auto [frames, error] = read_all(folder_.string());
    EXPECT_EQ(frames.size(), 1u);
    EXPECT_THAT(error, HasSubstr(path("2.png") + ": is "));
  }
}

TEST_F(FrameSourceTest, SingleImageIsOneFrame) {
  write_png(path("a.png"), 1);
  fs::rename(path("a.png"), path("100%d.png"));  // which FFmpeg would take for a pattern
  const auto [frames, error] = read_all(path("100%d.png"));
  EXPECT_EQ(error, "");
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].image, "100%d.png");
}

TEST_F(FrameSourceTest, ReadFramesInAnyOrder) {
  const TestClip clip{.path = path("a.mkv")};
  const std::vector<PictureBytes> whole = write_and_read(clip);
  const std::vector<std::int64_t> wanted{7, 0, 11, 7};
  const std::vector<Frame> frames = read_frames({.location = clip.path}, wanted);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(frames[i].index, wanted[i]);
    EXPECT_EQ(samples_of(frames[i]), whole[static_cast<std::size_t>(wanted[i])]);
  }
  try {
    read_frame({.location = clip.path}, 12);
    FAIL() << "there is no frame 12";
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), clip.path + ": has 12 frames, frame 12 was asked for");
  }
  EXPECT_THROW(read_frame({.location = clip.path}, -1), Error);
}

TEST_F(FrameSourceTest, WhatIsNoSourceIsNamed) {
  EXPECT_EQ(read_all(path("none.mkv")).error, path("none.mkv") + ": does not exist");
  write_bytes(path("empty.mkv"), "");
  EXPECT_EQ(read_all(path("empty.mkv")).error, path("empty.mkv") + ": is empty, must be a video or an image");
  write_bytes(path("text.mkv"), "this is no video at all");
  EXPECT_THAT(read_all(path("text.mkv")).error, HasSubstr(path("text.mkv") + ": cannot be opened as a video"));
  fs::create_directory(path("folder"));
  EXPECT_THAT(read_all(path("folder")).error, HasSubstr(path("folder") + ": is a folder without images"));
  EXPECT_THAT(read_all("").error, HasSubstr("source: is empty"));
  EXPECT_THAT(read_all("gopher://nowhere").error, HasSubstr("gopher://nowhere: cannot be opened as a video"));
  const RawFormat raw{PixelFormat::nv12, 8, 6, ColorRange::limited, 10};
  EXPECT_THAT(read_all({.location = path("folder"), .raw = raw}).error, HasSubstr("is a folder"));
}

TEST(RawFormat, NamesWhatIsOutOfRange) {
  const auto message = [](const RawFormat& raw) -> std::string {
    try {
      raw.check();
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  };
  const RawFormat good{PixelFormat::nv12, 640, 480, ColorRange::full, 30};
  EXPECT_EQ(message(good), "");
  RawFormat wide = good;
  wide.width = 32768;
  EXPECT_EQ(message(wide), "raw frame size: is 32768x480 px, must be 1..32767 in both directions");
  RawFormat flat = good;
  flat.height = 0;
  EXPECT_EQ(message(flat), "raw frame size: is 640x0 px, must be 1..32767 in both directions");
  RawFormat still = good;
  still.fps = 0;
  EXPECT_THAT(message(still), HasSubstr("raw frame rate: is 0"));
}

TEST_F(FrameSourceTest, LargerThanRunsCanAddressIsAnError) {
  const TestClip clip{
      .path = path("wide.png"), .encoder = "png", .format = AV_PIX_FMT_GRAY8, .width = 32768, .height = 1};
  write_clip(clip, {noise_picture(clip, 1)}, {0});
  EXPECT_EQ(read_all(clip.path).error, clip.path + ": is 32768x1 px, must be 1..32767 in both directions");
}

// The rendered recordings: as many frames as lines of truth, each at its line's time.
TEST(FrameSourceOnRecordings, TimesAreTheTruthsTimes) {
  const fs::path data = fs::path(TASSILO_SOURCE_DIR) / "../shared/data/msl98";
  if (!fs::exists(data)) GTEST_SKIP() << "needs ../shared/data/msl98";
  for (const std::string sequence : {"d01_approach", "d06_vga"}) {
    SCOPED_TRACE(sequence);
    FrameSource source = open_source({.location = (data / sequence / "video.mkv").string()});
    EXPECT_EQ(source.info().range, sequence == "d01_approach" ? ColorRange::limited : ColorRange::full);
    std::ifstream truth(data / sequence / "gt.jsonl");
    for (std::string line; std::getline(truth, line);) {
      const auto frame = source.next();
      ASSERT_TRUE(frame);
      EXPECT_EQ(line.find("{\"frame\":" + std::to_string(frame->index) + ","), 0u);
      EXPECT_EQ(std::stod(line.substr(line.find("\"t\":") + 4)), frame->t);
    }
    EXPECT_FALSE(source.next());
  }
}

}  // namespace
}  // namespace tassilo
