#include "tassilo/evaluate/evaluate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "tassilo/base/error.h"
#include "tassilo/evaluate/internal/label_maps.h"
#include "tassilo/evaluate/internal/pose_judgement.h"
#include "tassilo/evaluate/internal/statistics.h"
#include "tassilo/evaluate/internal/true_ranges.h"
#include "tassilo/files/png.h"

namespace tassilo {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

// One frame of truth: we stand at the field's centre and look to the blue goal; a ball 2 m ahead, a cylinder 3 m to the
// left.
const std::string kTruth =
    R"({"frame": 0, "t": 0.0, "robot": {"x": 0, "y": 0, "theta": 0},)"
    R"( "ball": {"rx": 2, "ry": 0, "dist": 2, "visible_px": 90, "visible_fraction": 1, "bbox": [10, 10, 19, 19], "bbox_full": [10, 10, 19, 19], "truncated": false},)"
    R"( "robots": [{"x": 0, "y": 3, "theta": 0, "rx": 0, "ry": 3, "rtheta": 0, "team_color": "cyan", "shape": "cylinder", "size": [0.4, 0.4, 0.5], "visible_px": 90, "visible_fraction": 1, "bbox": [40, 10, 59, 39], "bbox_full": [40, 10, 59, 39], "truncated": false}],)"
    R"( "goals": {"yellow": {"rx": -4, "ry": 0, "visible_px": 0, "visible_fraction": 0, "bbox": null, "bbox_full": null, "truncated": false},)"
    R"( "blue": {"rx": 4, "ry": 0, "visible_px": 400, "visible_fraction": 1, "bbox": [100, 0, 149, 19], "bbox_full": [100, 0, 149, 19], "truncated": false}},)"
    R"( "free": {"camera": {"origin": [0, 0], "ray": [4.1, 2, null, 2], "foot_px": [[1, 1], [2, 2], null, [3, 3]], "foot_hidden": [false, false, null, true]}}})"
    "\n";
const std::string kMeta = R"({"field": {"length": 8, "width": 10, "goal_width": 2, "goal_depth": 0.5, "walls": true}})";

// What a perfect observer says of it.
const std::string kScene =
    R"({"frame": 0, "t": 0.0, "pose": {"x": 0, "y": 0, "theta": 0, "cov": [1,0,0, 0,1,0, 0,0,1], "kind": "two_lines"},)"
    R"( "balls": [{"x": 2, "y": 0, "distance": 2, "near": 1.9, "far": 2.1, "cov": [0.01, 0, 0, 0.01], "box": [10, 10, 20, 20]}],)"
    R"( "goals": [{"color": "blue", "box": [100, 0, 150, 20], "bearing": 0}],)"
    R"( "robots": [{"team": "cyan", "x": 0, "y": 2.8, "distance": 2.8, "near": 2.7, "far": 2.9, "center": [0, 3], "box": [40, 10, 60, 40]}],)"
    R"( "free_space": {"origin": [0, 0], "angle_min": 1.5707963267948966, "angle_increment": 0.01, "ranges": [2.8], "state": ["blocked"]},)"
    R"( "lines": [], "why": {}, "timing_ms": {"total": 2.5}})"
    "\n";

class Evaluate : public ::testing::Test {
 protected:
  Evaluate()
      : folder_(fs::path(::testing::TempDir()) / ("tassilo_evaluate_" + std::to_string(std::random_device{}()) + "_" +
                                                  ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_);
    write("gt.jsonl", kTruth);
    write("meta.json", kMeta);
  }
  ~Evaluate() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
  SequenceScore score(const std::string& scenes) const {
    write("scenes.jsonl", scenes);
    return *evaluate(options()).overall;
  }
  std::string refusal(const std::string& scenes) const {
    try {
      score(scenes);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  EvaluateOptions options() const {
    EvaluateOptions out;
    out.sequences.push_back({folder_ / "gt.jsonl", folder_ / "scenes.jsonl"});
    return out;
  }
  /// kScene with one part of its text replaced.
  static std::string scene_with(const std::string& part, const std::string& by) {
    std::string out = kScene;
    const auto at = out.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return out.replace(at, part.size(), by);
  }

  fs::path folder_;
};

TEST_F(Evaluate, PerfectScenesScorePerfectly) {
  const SequenceScore s = score(kScene);
  EXPECT_EQ(s.frames, 1);
  EXPECT_EQ(s.frames_missing, 0);
  EXPECT_EQ(s.pose.good, 1);
  EXPECT_EQ(s.pose.first_fix, 0);
  EXPECT_EQ(s.pose.nees_mean, 0);
  EXPECT_EQ(s.ball.recall_best, 1);
  EXPECT_EQ(s.ball.precision_all, 1);
  EXPECT_EQ(s.ball.error_m.max, 0);
  EXPECT_EQ(s.ball.bracketed, 1);
  EXPECT_NEAR(*s.ball.bracket_width_relative, .1, 1e-12);
  EXPECT_EQ(s.blue.recall, 1);
  EXPECT_FALSE(s.yellow.recall);
  EXPECT_EQ(s.goals.precision, 1);
  EXPECT_EQ(s.goals.bearing_deg.max, 0);
  EXPECT_EQ(s.robots.recall, 1);
  EXPECT_EQ(s.robots.team_right, 1);
  EXPECT_NEAR(*s.robots.to_nearest_m.max, 0, 1e-12);
  EXPECT_EQ(s.free_space.sectors, 1);
  EXPECT_EQ(s.free_space.dangerous, 0);
  EXPECT_EQ(s.free_space.timid, 0);
  EXPECT_EQ(s.free_space.coverage, 1);  // the foot 4.1 m away is too far, one is not shown, one is hidden
  EXPECT_LT(*s.free_space.error_m.max, 1e-3);
  EXPECT_EQ(s.timing_ms.at("total").median, 2.5);
  EXPECT_TRUE(s.notes.empty());
}

TEST_F(Evaluate, MissingLinesCountAsNothingSeen) {
  write("gt.jsonl", kTruth + std::string(kTruth).replace(10, 1, "1"));
  const SequenceScore s = score(kScene);
  EXPECT_EQ(s.frames, 2);
  EXPECT_EQ(s.frames_missing, 1);
  EXPECT_EQ(s.pose.share, .5);
  EXPECT_EQ(s.ball.recall_best, .5);
  EXPECT_EQ(s.ball.precision_best, 1);
  EXPECT_EQ(s.robots.recall, .5);
  EXPECT_EQ(s.free_space.coverage, .5);
  ASSERT_EQ(s.notes.size(), 1u);
  EXPECT_THAT(s.notes[0], HasSubstr("1 frames without a scene line"));
}

TEST_F(Evaluate, WrongAnswersAreCounted) {
  EXPECT_EQ(score(scene_with(R"("ranges": [2.8])", R"("ranges": [3.5])")).free_space.dangerous, 1);
  EXPECT_EQ(score(scene_with(R"("ranges": [2.8])", R"("ranges": [1])")).free_space.timid, 1);
  EXPECT_EQ(score(scene_with(R"("far": 2.1)", R"("far": 1.99)")).ball.bracketed, 0);
  EXPECT_EQ(score(scene_with(R"("far": 2.1)", R"("far": null)")).ball.bracketed, 0);
  EXPECT_EQ(score(scene_with(R"("box": [10, 10, 20, 20])", R"("box": [70, 70, 80, 80])")).ball.recall_any, 0);
  EXPECT_EQ(score(scene_with(R"("team": "cyan")", R"("team": "magenta")")).robots.team_swapped, 1);
  EXPECT_EQ(score(scene_with(R"("team": "cyan")", R"("team": "unknown")")).robots.team_swapped, 0);
  EXPECT_EQ(score(scene_with(R"("color": "blue")", R"("color": "yellow")")).goals.precision, 0);
  EXPECT_EQ(score(scene_with(R"("theta": 0)", R"("theta": 0.3)")).pose.wrong, 1);
  EXPECT_NEAR(*score(scene_with(R"("x": 2, "y": 0)", R"("x": 2.1, "y": 0.1)")).ball.nees_mean, 2, 1e-9);
}

TEST_F(Evaluate, WithoutFieldFreeSpaceIsLeftOut) {
  fs::remove(folder_ / "meta.json");
  const SequenceScore s = score(kScene);
  EXPECT_EQ(s.free_space.sectors, 0);
  EXPECT_FALSE(s.free_space.coverage);
}

TEST_F(Evaluate, RefusesNamingFileAndLine) {
  EXPECT_THAT(refusal(kScene + "{\n"), HasSubstr("scenes.jsonl:2"));
  EXPECT_THAT(refusal(kScene + "\n" + kScene), HasSubstr("scenes.jsonl:2: is an empty line"));
  EXPECT_THAT(refusal(kScene + kScene), HasSubstr("scenes.jsonl:2: frame 0 appears twice"));
  EXPECT_THAT(refusal(scene_with(R"("frame": 0)", R"("frame": 7)")), HasSubstr("scenes.jsonl:1: frame 7 is not in "));
  EXPECT_THAT(refusal(scene_with(R"("near": 1.9, )", "")), HasSubstr("balls[0].near"));
  EXPECT_THAT(refusal(scene_with(R"("near": 1.9)", R"("near": "x")")), HasSubstr("balls[0].near"));
  EXPECT_THAT(refusal(scene_with(R"([10, 10, 20, 20])", "[10, 10, 20]")), HasSubstr("balls[0].box"));
  EXPECT_THAT(refusal(scene_with(R"("state": ["blocked"])", R"("state": [])")), HasSubstr("1 ranges but 0 states"));
  EXPECT_THAT(refusal(scene_with(R"("state": ["blocked"])", R"("state": ["unseen"])")),
              HasSubstr("its state is unseen"));
  EXPECT_THAT(refusal(scene_with(R"("angle_increment": 0.01)", R"("angle_increment": 0)")),
              HasSubstr("angle_increment"));
  EXPECT_THAT(refusal(scene_with(R"("total": 2.5)", R"("all": 2.5)")), HasSubstr("timing_ms.total"));
  EXPECT_THAT(refusal(""), HasSubstr("has no lines"));
  write("meta.json", "{}");
  EXPECT_THAT(refusal(kScene), HasSubstr("meta.json"));
  fs::remove(folder_ / "gt.jsonl");
  EXPECT_THAT(refusal(kScene), HasSubstr("gt.jsonl"));
}

TEST_F(Evaluate, NamesSequencesByFolderAndPoolsThem) {
  write("scenes.jsonl", kScene);
  write("others.jsonl", kScene);
  EvaluateOptions two = options();
  two.sequences.push_back({folder_ / "gt.jsonl", folder_ / "others.jsonl"});
  const Evaluation both = evaluate(two);
  ASSERT_EQ(both.sequences.size(), 2u);
  EXPECT_EQ(both.sequences[0].first, folder_.filename());
  EXPECT_THAT(both.sequences[1].first, HasSubstr("others.jsonl"));
  EXPECT_EQ(both.overall->frames, 2);
  EXPECT_THAT(table(both), HasSubstr(folder_.filename().string()));

  two.sequences.push_back(two.sequences[1]);
  EXPECT_THROW(evaluate(two), Error);
}

TEST_F(Evaluate, EmptyQuestionEmptyAnswer) {
  EXPECT_EQ(table(evaluate({})), "");
  EXPECT_EQ(to_json(evaluate({})), "{}\n");
}

TEST_F(Evaluate, LabelMapsCountInnerPixelsOnly) {
  // Left half white, right half green; the map takes all for white. The columns at the border do not count.
  GrayImage labels{8, 4, {}};
  for (int i = 0; i < 32; ++i) labels.pixels.push_back(i % 8 < 4 ? 2 : 3);
  labels.pixels[0] = 255;
  fs::create_directories(folder_ / "labels");
  fs::create_directories(folder_ / "maps");
  write_png_gray(folder_ / "labels/0000.png", labels);
  write_png_gray(folder_ / "maps/0000.png", {8, 4, std::vector<std::uint8_t>(32, 2)});
  EvaluateOptions ask;
  ask.colors.push_back({folder_ / "labels", folder_ / "maps"});
  const ColorScore s = *evaluate(ask).colors;
  EXPECT_EQ(s.classes[2].pixels, 3 * 4 - 4);  // less the ignored corner and its neighbors
  EXPECT_EQ(s.classes[3].pixels, 3 * 4);
  EXPECT_EQ(s.classes[2].recall, 1);
  EXPECT_EQ(s.classes[3].recall, 0);
  EXPECT_FALSE(s.classes[3].precision);
  EXPECT_EQ(s.mean_recall, .5);
  EXPECT_EQ(s.mean_over, 2);

  write_png_gray(folder_ / "maps/0000.png", {4, 4, std::vector<std::uint8_t>(16, 2)});
  EXPECT_THROW(evaluate(ask), Error);
  write_png_gray(folder_ / "maps/0000.png", {8, 4, std::vector<std::uint8_t>(32, 9)});
  EXPECT_THROW(evaluate(ask), Error);
  fs::remove(folder_ / "maps/0000.png");
  EXPECT_THROW(evaluate(ask), Error);
}

TEST(PoseJudgement, MirrorTakesTheNearer) {
  const TruePose truth{1, .5, .2};
  ReportedPose pose{-1.02, -.5, .2 - M_PI, {}, false, true};
  EXPECT_NEAR(judge_pose(pose, truth).position_m, .02, 1e-12);
  EXPECT_FALSE(judge_pose(pose, truth).wrong);
  EXPECT_FALSE(judge_pose(pose, truth).good);
  EXPECT_TRUE(judge_pose(pose, truth).good_mirrored);
  pose.mirror = false;
  EXPECT_TRUE(judge_pose(pose, truth).wrong);
  // Near in place but turned round is worse than right but a little off.
  EXPECT_NEAR(judge_pose({.1, 0, M_PI, {}, false, true}, {-.05, 0, 0}).position_m, .05, 1e-12);
}

TEST(NormalizedSquaredError, NeedsAPositiveDefiniteMatrix) {
  EXPECT_NEAR(*normalized_squared_error(Eigen::Vector2d(1, 2), {4, 0, 0, 1}), 4.25, 1e-12);
  EXPECT_FALSE(normalized_squared_error(Eigen::Vector2d(1, 2), {1, 2, 2, 1}));
  EXPECT_FALSE(normalized_squared_error(Eigen::Vector2d(1, 2), {0, 0, 0, 0}));
}

TEST(Quantile, InterpolatesBetweenNeighbors) {
  EXPECT_EQ(quantile({3, 1, 2}, .5), 2);
  EXPECT_NEAR(*quantile({1, 2, 3, 4}, .9), 3.7, 1e-12);
  EXPECT_EQ(quantile({7}, .99), 7);
  EXPECT_FALSE(quantile({}, .5));
  EXPECT_FALSE(quantile({1, INFINITY}, .5));
}

TEST(NearestOutlinePoint, OfCylindersAndTurnedBoxes) {
  TrueRobot robot{{}, {3, 4, .3}, "cyan", false, {1, 1, .5}, {}};
  EXPECT_LT(distance(nearest_outline_point(robot), {3 * .9, 4 * .9}), 1e-12);
  robot = {{}, {3, 0, M_PI / 4}, "cyan", true, {.4, .4, .5}, {}};  // a corner looks at us
  EXPECT_LT(distance(nearest_outline_point(robot), {3 - std::sqrt(.08), 0}), 1e-12);
  robot = {{}, {3, .1, M_PI / 2}, "cyan", true, {.6, .4, .5}, {}};
  EXPECT_LT(distance(nearest_outline_point(robot), {2.8, 0}), 1e-12);
}

TEST(TrueObstacles, RangesToWallsGoalsAndRobots) {
  TrueFrame frame;
  frame.robot = {1, .5, M_PI / 2};  // looks to +y: the blue goal is on the right
  frame.robots.push_back({{1, 2, 0}, {}, "cyan", false, {.4, .4, .5}, {}});
  frame.robots.push_back({{-1, .5, 0}, {}, "cyan", true, {.6, .4, .5}, {}});
  const TrueObstacles all({.length = 8, .width = 5, .goal_width = 2, .goal_depth = .5, .walls = true}, frame);
  EXPECT_NEAR(all.range({0, 0}, 0), 1.3, 1e-12);
  EXPECT_NEAR(all.range({0, 0}, M_PI / 2), 1.7, 1e-12);
  EXPECT_NEAR(all.range({0, 0}, M_PI), 3, 1e-12);
  EXPECT_NEAR(all.range({0, 0}, -M_PI / 2), 3.5, 1e-12);  // through the mouth to the goal's back
  EXPECT_NEAR(all.range({.6, 0}, -M_PI / 2), 3, 1e-12);   // beside it
  const TrueObstacles open({.length = 8, .width = 5, .goal_width = 2, .goal_depth = .5, .walls = false}, frame);
  EXPECT_EQ(open.range({0, 0}, M_PI), INFINITY);
}

}  // namespace
}  // namespace tassilo
