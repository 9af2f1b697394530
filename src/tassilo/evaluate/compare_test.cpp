#include "tassilo/evaluate/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tassilo/base/error.h"
#include "tassilo/files/scene_json.h"

namespace tassilo {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
namespace fs = std::filesystem;

using Scenes = std::vector<Scene>;
constexpr std::array kSubjects{"t", "pose", "balls", "goals", "robots", "lines", "free_space", "tracks", "why"};

Gaussian2<RobotFrame> near(double x, double y) { return {{x, y}, .01 * Eigen::Matrix2d::Identity()}; }

/// Scenes with something of everything, the same for the same seed.
Scenes random_scenes(unsigned seed, int count = 12) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Scenes out;
  for (int k = 0; k < count; ++k) {
    Scene s;
    s.frame = 3 + 2 * k;
    s.t = .05 * k;
    s.pose = PoseSeen{uniform(-4, 4), uniform(-2, 2), uniform(-3, 3), {1, 0, 0, 0, 1, 0, 0, 0, 1}, PoseKind::model, 0,
                      false};
    for (int i = 0; i < 3; ++i) {  // a grid of boxes that do not overlap
      const int x = 100 * i, y = 10 * static_cast<int>(uniform(0, 5));
      s.balls.push_back({{x, y, x + 20, y + 20},
                         {x + 10., y + 10.},
                         10,
                         .5,
                         BallOnFloor{near(uniform(1, 4), uniform(-2, 2)), {1, 2}}});
      s.robots.push_back({Team::cyan,
                          {x, y + 60, x + 40, y + 120},
                          RobotOnFloor{near(uniform(1, 4), uniform(-2, 2)), {1, 2}, {2, 0}, .4}});
      s.lines.push_back({LineKind::line, {x + 0., 200}, {x + 90., 200. + 20 * i}, {}, "halfway"});
    }
    s.goals.push_back({GoalColor::blue, {10, 10, 90, 50}, uniform(-1, 1), FloorPoint{3, uniform(-1, 1)}, {}});
    s.circles.push_back({{uniform(1, 3), 0}, 1});
    s.free_space = FreeSpace{
        {0, 0}, -.5, .1, {1, 2, uniform(1, 3)}, {SectorState::blocked, SectorState::free, SectorState::blocked}};
    s.why.emplace_back("pose", "lines agree");
    s.timing = {{"detect", uniform(1, 2)}, {"total", uniform(2, 3)}};
    out.push_back(std::move(s));
  }
  return out;
}

class Compare : public ::testing::Test {
 protected:
  Compare()
      : folder_(fs::path(::testing::TempDir()) / ("tassilo_compare_" + std::to_string(std::random_device{}()) + "_" +
                                                  ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_);
  }
  ~Compare() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  fs::path write(const std::string& name, const Scenes& scenes) const {
    std::string text;
    for (const Scene& scene : scenes) text += to_json_line(scene) + "\n";
    return write(name, text);
  }
  Comparison compared(const Scenes& a, const Scenes& b) const {
    return compare({write("a.jsonl", a), write("b.jsonl", b), {}, {}});
  }
  /// The same scenes, each changed.
  static Scenes changed(Scenes scenes, const std::function<void(Scene&)>& change) {
    for (Scene& scene : scenes) change(scene);
    return scenes;
  }
  std::string refusal(const std::string& a, const std::string& b) const {
    try {
      compare({write("a.jsonl", a), write("b.jsonl", b), {}, {}});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

std::vector<std::string> differing(const Comparison& c) {
  std::vector<std::string> out;
  for (const SubjectDifference& s : c.subjects)
    if (!s.frames.empty()) out.push_back(s.subject);
  return out;
}

void expect_swapped(const Paired& p, const Paired& q) {
  EXPECT_EQ(p.both, q.both);
  EXPECT_EQ(p.only_a, q.only_b);
  EXPECT_EQ(p.only_b, q.only_a);
}
void expect_same(const Spread& p, const Spread& q) {
  EXPECT_EQ(p.count, q.count);
  EXPECT_EQ(p.median, q.median);
  EXPECT_EQ(p.p90, q.p90);
  EXPECT_EQ(p.max, q.max);
}

TEST_F(Compare, WithItselfAllIsEqual) {
  const Scenes scenes = random_scenes(1);
  const Comparison c = compared(scenes, scenes);
  EXPECT_TRUE(c.equal());
  EXPECT_EQ(c.frames, 12);
  EXPECT_EQ(c.equal_frames, 12);
  std::vector<std::string> subjects;
  for (const SubjectDifference& s : c.subjects) {
    subjects.push_back(s.subject);
    EXPECT_THAT(s.frames, IsEmpty()) << s.subject;
  }
  EXPECT_THAT(subjects, ::testing::ElementsAreArray(kSubjects));
  for (const Paired& paired : {c.pose.frames, c.balls.balls, c.goals.goals, c.robots.robots, c.lines.lines,
                               c.lines.circles, c.free_space.frames}) {
    EXPECT_GE(paired.both, 12);
    EXPECT_EQ(paired.only_a + paired.only_b, 0);
  }
  for (const Spread& spread : {c.pose.distance_m, c.pose.turn_deg, c.balls.distance_m, c.balls.center_px,
                               c.goals.bearing_deg, c.goals.distance_m, c.robots.nearest_m, c.robots.center_m,
                               c.lines.ends_px, c.lines.center_m, c.free_space.range_m}) {
    EXPECT_EQ(spread.max, 0);
    EXPECT_GE(spread.count, 12);
  }
  EXPECT_EQ(c.free_space.state_differs + c.free_space.other_sectors + c.pose.kind_differs + c.pose.mirror_differs +
                c.robots.team_differs + c.lines.model_differs,
            0);
}

TEST_F(Compare, TimingMakesNoDifference) {
  const Scenes scenes = random_scenes(2);
  const Comparison c = compared(scenes, changed(scenes, [](Scene& s) {
                                  for (StageTime& time : s.timing) time.ms *= 2;
                                }));
  EXPECT_TRUE(c.equal());
  for (const auto& [stage, ms] : c.timing_ms_a) EXPECT_NEAR(*c.timing_ms_b.at(stage).median, 2 * *ms.median, 1e-3);
}

TEST_F(Compare, SwappedRunsMirrorTheCounts) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    Scenes a = random_scenes(seed), b = random_scenes(seed + 100);
    a.erase(a.begin() + 2);
    b.erase(b.begin() + 5, b.begin() + 8);
    a[0].pose.reset();
    b[1].free_space.reset();
    a[3].balls.pop_back();
    b[4].robots.clear();
    const Comparison c = compared(a, b), d = compared(b, a);
    EXPECT_EQ(c.frames, d.frames);
    EXPECT_EQ(c.equal_frames, d.equal_frames);
    EXPECT_EQ(c.only_a, d.only_b);
    EXPECT_EQ(c.only_b, d.only_a);
    ASSERT_EQ(c.subjects.size(), d.subjects.size());
    for (std::size_t i = 0; i < c.subjects.size(); ++i) {
      EXPECT_EQ(c.subjects[i].subject, d.subjects[i].subject);
      EXPECT_EQ(c.subjects[i].frames, d.subjects[i].frames);
    }
    expect_swapped(c.pose.frames, d.pose.frames);
    expect_swapped(c.balls.balls, d.balls.balls);
    expect_swapped(c.goals.goals, d.goals.goals);
    expect_swapped(c.robots.robots, d.robots.robots);
    expect_swapped(c.lines.lines, d.lines.lines);
    expect_swapped(c.lines.circles, d.lines.circles);
    expect_swapped(c.free_space.frames, d.free_space.frames);
    expect_same(c.pose.distance_m, d.pose.distance_m);
    expect_same(c.pose.turn_deg, d.pose.turn_deg);
    expect_same(c.balls.distance_m, d.balls.distance_m);
    expect_same(c.goals.bearing_deg, d.goals.bearing_deg);
    expect_same(c.robots.nearest_m, d.robots.nearest_m);
    expect_same(c.lines.ends_px, d.lines.ends_px);
    expect_same(c.free_space.range_m, d.free_space.range_m);
    EXPECT_EQ(c.free_space.state_differs, d.free_space.state_differs);
    EXPECT_EQ(c.timing_ms_a.at("total").median, d.timing_ms_b.at("total").median);
  }
}

TEST_F(Compare, FramesThatAreMissingAreNamed) {
  const Scenes a = random_scenes(3);
  for (int k = 0; k < 12; ++k) {
    SCOPED_TRACE(k);
    const Comparison c = compared(a, Scenes(a.begin() + k, a.end()));
    EXPECT_THAT(c.only_b, IsEmpty());
    EXPECT_EQ(c.frames, 12 - k);
    EXPECT_EQ(c.equal_frames, 12 - k);
    EXPECT_EQ(c.equal(), k == 0);
    std::vector<std::int64_t> missing;
    for (int i = 0; i < k; ++i) missing.push_back(a[static_cast<std::size_t>(i)].frame);
    EXPECT_EQ(c.only_a, missing);
  }
}

TEST_F(Compare, TellsByHowMuchThePoseDiffers) {
  const Scenes scenes = random_scenes(4);
  for (const double d : {1e-5, .01, 3.}) {
    SCOPED_TRACE(d);
    const Comparison c = compared(scenes, changed(scenes, [&](Scene& s) {
                                    s.pose->x += .6 * d;
                                    s.pose->y -= .8 * d;
                                    s.pose->theta += d + 2 * M_PI;
                                  }));
    EXPECT_THAT(differing(c), ElementsAre("pose"));
    EXPECT_EQ(c.equal_frames, 0);
    for (const auto& value : {c.pose.distance_m.median, c.pose.distance_m.p90, c.pose.distance_m.max})
      EXPECT_NEAR(*value, d, 2e-6);  // lines are rounded to 6 decimals
    for (const auto& value : {c.pose.turn_deg.median, c.pose.turn_deg.p90, c.pose.turn_deg.max})
      EXPECT_NEAR(*value, d / M_PI * 180, 1e-4);
    EXPECT_EQ(c.pose.frames.both, 12);
  }
}

TEST_F(Compare, TellsWhatOneAloneSees) {
  const Scenes scenes = random_scenes(5);
  const Comparison c = compared(scenes, changed(scenes, [](Scene& s) {
                                  s.balls.erase(s.balls.begin());
                                  s.balls[0].floor->position.mean.x += .25;
                                  s.goals[0].color = GoalColor::yellow;
                                  s.robots[1].team = Team::magenta;
                                  s.lines[2].model = "circle";
                                  s.free_space->states[0] = SectorState::free;
                                  s.free_space->ranges[1] += .5;
                                  s.pose->mirror = true;
                                  s.pose->kind = PoseKind::goal;
                                }));
  EXPECT_THAT(differing(c), ElementsAre("pose", "balls", "goals", "robots", "lines", "free_space"));
  EXPECT_EQ(c.balls.balls.both, 24);
  EXPECT_EQ(c.balls.balls.only_a, 12);
  EXPECT_EQ(c.balls.balls.only_b, 0);
  EXPECT_NEAR(*c.balls.distance_m.max, .25, 2e-6);
  EXPECT_EQ(c.goals.goals.only_a, 12);
  EXPECT_EQ(c.goals.goals.only_b, 12);
  EXPECT_EQ(c.robots.team_differs, 12);
  EXPECT_EQ(c.lines.model_differs, 12);
  EXPECT_EQ(c.free_space.state_differs, 12);
  EXPECT_EQ(c.free_space.sectors, 36);
  EXPECT_NEAR(*c.free_space.range_m.max, .5, 2e-6);
  EXPECT_EQ(c.pose.mirror_differs, 12);
  EXPECT_EQ(c.pose.kind_differs, 12);
}

TEST_F(Compare, PairsWhatIsMostAlike) {
  Scenes a = random_scenes(6, 1);
  a[0].balls = {{{0, 0, 20, 20}, {10, 10}, 10, .5, {}}, {{4, 0, 24, 20}, {14, 10}, 10, .5, {}}};
  Scenes b = a;
  std::swap(b[0].balls[0], b[0].balls[1]);
  const Comparison c = compared(a, b);
  EXPECT_EQ(c.balls.balls.both, 2);
  EXPECT_EQ(c.balls.center_px.max, 0);
  EXPECT_EQ(c.balls.distance_m.count, 0);
  EXPECT_THAT(differing(c), ElementsAre("balls"));  // the order counts: the best is first
}

TEST_F(Compare, SectorsThatLieElsewhereAreNotCompared) {
  const Scenes scenes = random_scenes(7);
  const Comparison c = compared(scenes, changed(scenes, [](Scene& s) { s.free_space->angle_min += .01; }));
  EXPECT_EQ(c.free_space.other_sectors, 12);
  EXPECT_EQ(c.free_space.sectors, 0);
}

TEST_F(Compare, TableNamesTheFirstFrames) {
  Scenes a = random_scenes(8), b = changed(a, [](Scene&s) { s.pose->x += .1; });
  b.erase(b.begin());
  const Comparison c = compared(a, b);
  EXPECT_THAT(table(c, 3), HasSubstr("5, 7, 9, and 8 more"));
  EXPECT_THAT(table(c, 0), Not(HasSubstr("more")));
  EXPECT_THAT(table(c, 99), Not(HasSubstr("more")));
  EXPECT_THAT(table(c, 3), HasSubstr("0.100000 m"));
  EXPECT_THAT(table(compared(a, a), 3), HasSubstr("the runs are equal"));
  EXPECT_THAT(to_json(c), HasSubstr("\"equal\": false"));
}

TEST_F(Compare, RefusesWhatDoesNotBelongTogether) {
  const std::string line = to_json_line(random_scenes(9, 1)[0]) + "\n";
  const auto with = [&](const std::function<void(Scene&)>& change) {
    return to_json_line(changed(random_scenes(9, 1), change)[0]) + "\n";
  };
  EXPECT_EQ(refusal(line, line), "");
  EXPECT_THAT(refusal(line, ""), HasSubstr("b.jsonl: has no lines"));
  EXPECT_THAT(refusal("", line), HasSubstr("a.jsonl: has no lines"));
  EXPECT_THAT(refusal(line + "{\n", line), HasSubstr("a.jsonl:2"));
  EXPECT_THAT(refusal(line, R"({"frame": 3, "t": 0})"), HasSubstr("b.jsonl:1"));
  EXPECT_THAT(refusal(line, line + line), HasSubstr("b.jsonl:2: frame 3 appears twice"));
  EXPECT_THAT(refusal(line, with([](Scene& s) { s.frame = 4; })), HasSubstr("has no frame of"));
  EXPECT_THAT(refusal(line, with([](Scene& s) { s.t = .02; })), HasSubstr("frame 3 is at t = 0.02"));
  EXPECT_THAT(refusal(line, with([](Scene& s) { s.image = "x.png"; })), HasSubstr("frame 3 is image x.png"));
  const std::string later = with([](Scene& s) { s.t = .005; });  // as another container rounds it
  EXPECT_EQ(refusal(line, later), "");
  EXPECT_THAT(differing(compare({folder_ / "a.jsonl", folder_ / "b.jsonl", {}, {}})), ElementsAre("t"));
  EXPECT_THROW(compare({folder_ / "none.jsonl", folder_ / "b.jsonl", {}, {}}), Error);
  EXPECT_THROW(compare({folder_ / "a.jsonl", folder_ / "b.jsonl", folder_ / "none.jsonl", {}}), Error);
}

}  // namespace
}  // namespace tassilo
