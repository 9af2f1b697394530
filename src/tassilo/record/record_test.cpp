extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tassilo/base/error.h"
#include "tassilo/record/image_folder.h"
#include "tassilo/record/json_lines_writer.h"
#include "tassilo/record/picture_writer.h"
#include "tassilo/record/video_writer.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A folder of its own for each test, gone afterwards.
class RecordTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / ("tassilo_record_" + std::string(test->name()) + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_)) all.push_back(entry.path().filename().string());
    return all;
  }

  fs::path folder_;
};

std::string read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Picture plain_picture(int width, int height, std::array<std::uint8_t, 3> color) {
  Picture picture{width, height, {}};
  for (int i = 0; i < width * height; ++i) picture.pixels.insert(picture.pixels.end(), color.begin(), color.end());
  return picture;
}

struct VideoContent {
  int width = 0, height = 0;
  std::vector<std::int64_t> stamps;         ///< [ms]
  std::vector<std::array<int, 3>> corners;  ///< Y, U, V of the first pixel of each picture.
};

VideoContent read_video(const std::string& path) {
  VideoContent content;
  AVFormatContext* input = nullptr;
  EXPECT_EQ(avformat_open_input(&input, path.c_str(), nullptr, nullptr), 0);
  EXPECT_GE(avformat_find_stream_info(input, nullptr), 0);
  const AVStream* stream = input->streams[0];
  AVCodecContext* codec = avcodec_alloc_context3(avcodec_find_decoder(stream->codecpar->codec_id));
  avcodec_parameters_to_context(codec, stream->codecpar);
  EXPECT_EQ(avcodec_open2(codec, nullptr, nullptr), 0);
  content.width = codec->width;
  content.height = codec->height;
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  for (bool more = true; more;) {
    more = av_read_frame(input, packet) >= 0;
    avcodec_send_packet(codec, more ? packet : nullptr);
    av_packet_unref(packet);
    while (avcodec_receive_frame(codec, frame) >= 0) {
      content.stamps.push_back(av_rescale_q(frame->pts, stream->time_base, {1, 1000}));
      content.corners.push_back({frame->data[0][0], frame->data[1][0], frame->data[2][0]});
    }
  }
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&codec);
  avformat_close_input(&input);
  return content;
}

// As many pictures as were given, at their times from the first on, in their BT.601 colors, under the right name only.
TEST_F(RecordTest, VideoHoldsEveryPictureAtItsTime) {
  const std::vector<double> times{1.7e9, 1.7e9 + .05, 1.7e9 + .1, 1.7e9 + .1, 1.7e9 + .5, 1.7e9 + .3, 1.7e9 + 2};
  for (const std::string name : {"a.mkv", "b.mp4"})
    for (const auto& [width, height] : {std::pair{64, 48}, {63, 47}}) {
      SCOPED_TRACE(name + " " + std::to_string(width));
      VideoWriter writer(path(name));
      for (std::size_t k = 0; k < times.size(); ++k) {
        writer.write(plain_picture(width, height, {static_cast<std::uint8_t>(30 * k), 20, 200}), times[k]);
        EXPECT_EQ(fs::exists(path(name)), width == 63) << "only an older one of that name";
      }
      writer.finish();
      writer.finish();
      const VideoContent content = read_video(path(name));
      EXPECT_EQ(content.width, 64);
      EXPECT_EQ(content.height, 48);
      EXPECT_THAT(content.stamps, testing::ElementsAre(0, 50, 100, 101, 500, 501, 2000));
      ASSERT_EQ(content.corners.size(), times.size());
      for (std::size_t k = 0; k < times.size(); ++k) {
        const double r = 30 * static_cast<double>(k), y = .299 * r + .587 * 20 + .114 * 200;
        EXPECT_NEAR(content.corners[k][0], 16 + 219 * y / 255, 3);
        EXPECT_NEAR(content.corners[k][1], 128 + 224 * (200 - y) / 1.772 / 255, 3);
        EXPECT_NEAR(content.corners[k][2], 128 + 224 * (r - y) / 1.402 / 255, 3);
      }
    }
  EXPECT_THAT(names(), testing::UnorderedElementsAre("a.mkv", "b.mp4"));
}

TEST_F(RecordTest, VideoIsFinishedWithItsWriter) {
  { VideoWriter(path("none.mkv")); }
  EXPECT_TRUE(names().empty()) << "no pictures, no video";
  {
    VideoWriter writer(path("a.mkv"));
    writer.write(plain_picture(64, 48, {1, 2, 3}), 0);
  }
  EXPECT_EQ(read_video(path("a.mkv")).stamps.size(), 1u);
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST_F(RecordTest, VideoErrorsNameTheTarget) {
  EXPECT_EQ(message_of([&] { VideoWriter writer(path("a.gif")); }),
            path("a.gif") + ": is no name for a video, must end in .mkv or .mp4");
  EXPECT_EQ(message_of([&] { VideoWriter writer(path("no/a.mkv")); }),
            path("no") + ": is no folder to write a video into");
  EXPECT_THAT(message_of([&] { VideoWriter writer(path("a.mkv"), {.quality = 52}); }),
              HasSubstr("video.quality: is 52"));
  VideoWriter writer(path("a.mkv"));
  writer.write(plain_picture(64, 48, {1, 2, 3}), 0);
  EXPECT_EQ(message_of([&] {
              writer.write(plain_picture(64, 50, {1, 2, 3}), 1);
            }),
            path("a.mkv") + ": picture 1 is 64x50 px, must be 64x48 like the first");
}

TEST_F(RecordTest, FolderHoldsImagesByFrame) {
  const ImageFolder folder(path("deep/er"));
  const GrayImage labels{3, 2, {0, 1, 2, 3, 8, 255}};
  folder.write(labels, 7);
  folder.write(labels, 123456);
  EXPECT_EQ(read_png_gray(path("deep/er/0007.png")), labels);
  EXPECT_EQ(read_png_gray(path("deep/er/123456.png")), labels);
  const Picture picture = plain_picture(5, 4, {10, 20, 30});
  folder.write(picture, 8);
  EXPECT_EQ(read_png_rgb(path("deep/er/0008.png")).pixels, picture.pixels);
  std::ofstream(path("file")) << "x";
  EXPECT_THAT(message_of([&] { ImageFolder blocked(path("file")); }), HasSubstr(path("file")));
}

TEST_F(RecordTest, PictureWriterTakesFolderOrVideoByName) {
  fs::create_directory(path("has.dot"));
  const Picture picture = plain_picture(64, 48, {10, 20, 30});
  for (const std::string target : {"pictures", "has.dot", "a.mkv"}) {
    PictureWriter writer(path(target));
    writer.write(picture, 3, .1);
    writer.finish();
  }
  EXPECT_TRUE(fs::exists(path("pictures/0003.png")));
  EXPECT_TRUE(fs::exists(path("has.dot/0003.png")));
  EXPECT_EQ(read_video(path("a.mkv")).stamps.size(), 1u);
  EXPECT_THAT(message_of([&] { PictureWriter writer(path("b.avi")); }), HasSubstr("must end in .mkv or .mp4"));
}

TEST_F(RecordTest, EachLineIsInTheFileAtOnce) {
  std::ofstream(path("a.jsonl")) << "an older run";
  JsonLinesWriter writer(path("a.jsonl"));
  EXPECT_EQ(read_bytes(path("a.jsonl")), "");
  writer.write("{\"frame\":0}");
  EXPECT_EQ(read_bytes(path("a.jsonl")), "{\"frame\":0}\n");
  const std::string large(1'000'000, 'x');
  writer.write(large);
  EXPECT_EQ(read_bytes(path("a.jsonl")), "{\"frame\":0}\n" + large + "\n");
  EXPECT_THAT(message_of([&] { JsonLinesWriter nowhere(path("no/a.jsonl")); }),
              HasSubstr("cannot be opened for writing"));
}

// A disk that is full in the middle of a line: a file size limit behaves like one.
TEST_F(RecordTest, FullDiskLeavesCompleteLines) {
  JsonLinesWriter writer(path("a.jsonl"));
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  const std::string line(300, 'x');
  int written = 0;
  const std::string message = message_of([&] {
    for (; written < 10; ++written) writer.write(line);
  });
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  EXPECT_EQ(written, 3);
  EXPECT_THAT(message, HasSubstr(path("a.jsonl") + ": cannot be written"));
  EXPECT_EQ(read_bytes(path("a.jsonl")), line + "\n" + line + "\n" + line + "\n");
}

// `tassilo run | head -1`: an Error, not the end of the program by SIGPIPE.
TEST_F(RecordTest, ReaderThatLeavesIsAnError) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  std::cout.flush();
  const int saved = ::dup(STDOUT_FILENO);
  ::dup2(pipe[1], STDOUT_FILENO);
  ::close(pipe[1]);
  JsonLinesWriter writer("-");
  writer.write("{}");
  std::array<char, 3> read{};
  EXPECT_EQ(::read(pipe[0], read.data(), read.size()), 3);
  ::close(pipe[0]);
  const std::string message = message_of([&] { writer.write("{}"); });
  ::dup2(saved, STDOUT_FILENO);
  ::close(saved);
  EXPECT_EQ(std::string(read.data(), 3), "{}\n");
  EXPECT_THAT(message, HasSubstr("standard output: cannot be written"));
}

}  // namespace
}  // namespace tassilo
