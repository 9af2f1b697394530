// The figures must be those of ../shared/tools/score.py, on scene files with seeded errors of every kind.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "tassilo/evaluate/evaluate.h"
#include "tassilo/files/png.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

const fs::path kShared = fs::path(TASSILO_SOURCE_DIR) / "../shared";
const fs::path kMsl98 = kShared / "data/msl98";

/// Every number, list and null of `expected` must be in `ours`, and nothing else; texts may be worded differently.
void expect_same(const nlohmann::json& ours, const nlohmann::json& expected, const std::string& where) {
  if (expected.is_number() && ours.is_number()) {
    const double a = ours.get<double>(), b = expected.get<double>();
    EXPECT_NEAR(a, b, 1e-9 * std::max(1., std::abs(b))) << where;
  } else if (expected.is_object() && ours.is_object()) {
    for (const auto& [key, value] : ours.items()) EXPECT_TRUE(expected.contains(key)) << where << "." << key;
    for (const auto& [key, value] : expected.items()) {
      ASSERT_TRUE(ours.contains(key)) << where << "." << key;
      expect_same(ours[key], value, where + "." + key);
    }
  } else if (expected.is_array() && ours.is_array()) {
    ASSERT_EQ(ours.size(), expected.size()) << where;
    for (std::size_t i = 0; i < ours.size(); ++i)
      expect_same(ours[i], expected[i], where + "[" + std::to_string(i) + "]");
  } else if (where.find(".notes[") != std::string::npos) {
    const std::string a = ours.get<std::string>(), b = expected.get<std::string>();
    EXPECT_EQ(a.substr(0, a.find(' ')), b.substr(0, b.find(' '))) << where;  // the count
  } else {
    EXPECT_EQ(ours, expected) << where;
  }
}

class ScoreTwin : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kShared / "tools/score.py") || !fs::exists(kMsl98))
      GTEST_SKIP() << "needs ../shared/tools and data";
    if (!runs(std::string(TASSILO_PYTHON) + " -c 'import numpy'")) GTEST_SKIP() << "needs python3 with numpy";
    folder_ = fs::path(::testing::TempDir()) / ("tassilo_score_twin_" + std::to_string(std::random_device{}()));
    fs::create_directories(folder_);
  }
  void TearDown() override {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }

  static bool runs(const std::string& command) { return std::system((command + " > /dev/null 2>&1").c_str()) == 0; }
  static std::string quoted(const fs::path& path) { return " '" + path.string() + "'"; }

  /// Writes scene files for the truths: scenes_0.jsonl, ...
  void perturb(int seed, const std::vector<fs::path>& truths) {
    std::string command = std::string(TASSILO_PYTHON) +
                          quoted(fs::path(TASSILO_SOURCE_DIR) / "tests/perturbed_scenes.py") + quoted(folder_) + " " +
                          std::to_string(seed);
    for (const auto& truth : truths) command += quoted(truth);
    ASSERT_TRUE(runs(command)) << command;
  }
  /// Judges by both programs and compares all numbers.
  void compare(const EvaluateOptions& options, const std::string& arguments) {
    const fs::path out = folder_ / "score.json";
    const std::string command =
        std::string(TASSILO_PYTHON) + quoted(kShared / "tools/score.py") + arguments + " --json" + quoted(out);
    ASSERT_TRUE(runs(command)) << command;
    std::ifstream file(out);
    const Evaluation evaluation = evaluate(options);
    expect_same(nlohmann::json::parse(to_json(evaluation)), nlohmann::json::parse(file), "");
    EXPECT_FALSE(table(evaluation).empty());
  }

  fs::path folder_;
};

TEST_F(ScoreTwin, CountsSequencesAlike) {
  std::vector<fs::path> truths;
  for (const char* name : {"d01_approach", "d04_nogoal_occl", "d05_distract", "d06_vga", "d08_xga"})
    truths.push_back(kMsl98 / name / "gt.jsonl");
  for (const int seed : {1, 100, 200}) {
    SCOPED_TRACE(seed);
    perturb(seed, truths);
    EvaluateOptions options;
    std::string arguments;
    for (std::size_t k = 0; k < truths.size(); ++k) {
      options.sequences.push_back({truths[k], folder_ / ("scenes_" + std::to_string(k) + ".jsonl")});
      arguments += quoted(truths[k]) + quoted(options.sequences.back().scenes);
    }
    compare(options, arguments);
  }
}

TEST_F(ScoreTwin, CountsOneSequenceWithoutItsFieldAlike) {
  const fs::path truth = folder_ / "approach.jsonl";
  fs::copy_file(kMsl98 / "d01_approach/gt.jsonl", truth);
  perturb(3, {truth});
  compare({.sequences = {{truth, folder_ / "scenes_0.jsonl"}}, .meta = {}, .colors = {}, .balls = {}, .poses = {}},
          quoted(truth) + quoted(folder_ / "scenes_0.jsonl"));
  const fs::path meta = kMsl98 / "d01_approach/meta.json";
  compare({.sequences = {{truth, folder_ / "scenes_0.jsonl"}}, .meta = meta, .colors = {}, .balls = {}, .poses = {}},
          quoted(truth) + quoted(folder_ / "scenes_0.jsonl") + " --meta" + quoted(meta));
}

TEST_F(ScoreTwin, CountsSingleImagesAlike) {
  perturb(4, {});
  const fs::path balls = folder_ / "balls.json", images = folder_ / "images.jsonl";
  const fs::path poses = folder_ / "poses.csv", draws = folder_ / "draws.jsonl";
  const std::string arguments =
      " --balls" + quoted(balls) + quoted(images) + " --poses" + quoted(poses) + quoted(draws);
  compare({.sequences = {},
           .meta = {},
           .colors = {},
           .balls = EvaluateOptions::BallImages{balls, images, {"image_05.png"}, folder_ / "samples.yaml"},
           .poses = EvaluateOptions::PoseImages{poses, draws}},
          arguments + " --exclude image_05.png --exclude-samples" + quoted(folder_ / "samples.yaml"));
}

TEST_F(ScoreTwin, CountsColorsAlike) {
  EvaluateOptions options;
  std::string arguments;
  std::mt19937 random(5);
  for (const char* name : {"d01_approach", "d06_vga"}) {
    const fs::path labels = folder_ / name / "labels", maps = folder_ / name / "maps";
    fs::create_directories(labels);
    fs::create_directories(maps);
    for (const char* file : {"0000.png", "0009.png", "0018.png"}) {
      fs::copy_file(kMsl98 / name / "labels" / file, labels / file);
      if (file == std::string("0009.png")) continue;  // the map is missing
      GrayImage map = read_png_gray(labels / file);
      for (std::uint8_t& label : map.pixels)
        if (label == 255 || random() % 10 == 0)
          label = static_cast<std::uint8_t>(random() % 8);  // yellow is never found
      write_png_gray(maps / file, map);
    }
    options.colors.push_back({labels, maps});
    arguments += " --colors" + quoted(labels) + quoted(maps);
  }
  compare(options, arguments);
}

}  // namespace
}  // namespace tassilo
