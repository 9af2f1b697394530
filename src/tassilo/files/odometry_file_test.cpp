#include "tassilo/files/odometry_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tassilo/files/internal/test_data.h"
#include "tassilo/files/internal/test_message.h"
#include "tassilo/files/setting.h"
#include "tassilo/files/test_folder.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

TEST(OdometryFile, ReadsEveryLineAlsoWithoutALastLineEnd) {
  const TestFolder folder;
  const auto file = folder.with(
      "o.jsonl",
      "{\"t\": 0.05, \"x\": 1, \"y\": -2e-1, \"theta\": 7}\r\n{\"theta\":0,\"y\":0,\"x\":0,\"t\":1700000000.25}");
  EXPECT_THAT(read_odometry(file),
              testing::ElementsAre(OdometrySample{0.05, 1, -0.2, 7}, OdometrySample{1700000000.25, 0, 0, 0}));
  EXPECT_TRUE(read_odometry(folder.with("empty.jsonl", "")).empty());
}

TEST(OdometryFile, KeepsTheOrderOfTheLines) {
  const TestFolder folder;
  const auto line = [](double t, double x) {
    return "{\"t\": " + number_text(t) + ", \"x\": " + number_text(x) + ", \"y\": 0, \"theta\": 0}\n";
  };
  const auto file = folder.with("o.jsonl", line(0.5, 1) + line(0.25, 2) + line(0.5, 3) + line(-1, 4));
  EXPECT_THAT(read_odometry(file), testing::ElementsAre(OdometrySample{0.5, 1, 0, 0}, OdometrySample{0.25, 2, 0, 0},
                                                        OdometrySample{0.5, 3, 0, 0}, OdometrySample{-1, 4, 0, 0}));
}

TEST(OdometryFile, MalformedLinesAreNamed) {
  const TestFolder folder;
  const std::string first = R"({"t": 0.5, "x": 0, "y": 0, "theta": 0})"
                            "\n";
  struct Case {
    std::string line, message;
  };
  const Case cases[] = {
      {R"({"t": 1, "x": 0, "y": 0})", "key 'theta' is missing"},
      {R"({"t": 1, "x": 0, "y": 0, "heading": 0})", "unknown key 'heading', must be t, x, y, theta or frame"},
      {R"({"t": 1, "t": 2, "x": 0, "y": 0, "theta": 0})", "key 't' appears twice, first at PLACE"},
      {R"({"t": 1, "x": null, "y": 0, "theta": 0})", "x is empty, must be a finite number"},
      {R"({"t": 1, "x": "0", "y": 0, "theta": 0})", "x is the text '0', must be a finite number"},
      {R"({"t": 1, "x": NaN, "y": 0, "theta": 0})", "is no valid JSON at character 15, near '\"x\": N'"},
      {R"({"t": 1, "x": 0, "y")", "is no valid JSON at character 21, near '\"y\"'"},
      {R"([1, 0, 0, 0])", "is a list, must be a map"},
      {"", "is no valid JSON at character 1, near ''"},
      {std::string(5000, ' '), "has more than 4096 bytes, which is the limit for a line"},
  };
  for (const Case& c : cases) {
    const auto file = folder.with("o.jsonl", first + c.line + "\n");
    const std::string place = file.string() + ":2";
    std::string expected = place + ": " + c.message;
    if (const auto at = expected.find("PLACE"); at != std::string::npos) expected.replace(at, 5, place);
    EXPECT_EQ(message_of([&] { read_odometry(file); }), expected);
  }
}

TEST(OdometryFile, SharedOdometryLoads) {
  if (!fs::exists(shared_data())) GTEST_SKIP() << "../shared/data is not there";
  for (const fs::path& file : files_named(shared_data(), "odometry.jsonl")) {
    SCOPED_TRACE(file);
    const auto samples = read_odometry(file);
    ASSERT_FALSE(samples.empty());
    EXPECT_EQ(samples.front(), OdometrySample{});
  }
}

TEST(OdometryFile, WrittenLinesReadBackToTheLastBit) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(-10, 10);
  for (int seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    OdometryLine line{{1.7e9 + any(random), any(random), seed % 3 == 0 ? -0. : any(random), any(random)}, std::nullopt};
    if (seed % 2 == 0) line.frame = seed;
    const OdometryLine read = read_odometry_line(odometry_line(line), "line");
    EXPECT_EQ(read, line);
    EXPECT_EQ(std::signbit(read.sample.y), std::signbit(line.sample.y));
  }
  EXPECT_THAT(message_of([] { read_odometry_line(R"({"t":0,"x":0,"y":0,"theta":0,"frame":-1})", "line"); }),
              testing::HasSubstr("frame is '-1', must be >= 0"));
}

}  // namespace
}  // namespace tassilo
