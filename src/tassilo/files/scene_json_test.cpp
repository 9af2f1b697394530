#include "tassilo/files/scene_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tassilo/files/internal/test_message.h"
#include "tassilo/files/internal/test_scene.h"
#include "tassilo/files/test_folder.h"

namespace tassilo {
namespace {

constexpr double kMetric = 0.51e-6, kPixel = 0.51e-3;

void expect_same(FloorPoint a, FloorPoint b) {
  EXPECT_NEAR(a.x, b.x, kMetric);
  EXPECT_NEAR(a.y, b.y, kMetric);
}
void expect_same(PixelPoint a, PixelPoint b) {
  EXPECT_NEAR(a.x, b.x, kPixel);
  EXPECT_NEAR(a.y, b.y, kPixel);
}
void expect_same(const Gaussian2<RobotFrame>& a, const Gaussian2<RobotFrame>& b) {
  expect_same(a.mean, b.mean);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(a.covariance(i), b.covariance(i), 1e-8 * std::abs(b.covariance(i)));
}
void expect_same(const DistanceBounds& a, const DistanceBounds& b) {
  EXPECT_NEAR(a.near, b.near, kMetric);
  if (std::isinf(b.far))
    EXPECT_EQ(a.far, b.far);
  else
    EXPECT_NEAR(a.far, b.far, kMetric);
}

// Reading gives the scene up to rounding, and a read scene is written as the same line.
TEST(SceneJson, RoundTrip) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = random_scene(seed);
    const std::string line = to_json_line(scene);
    const Scene read = scene_from_json(line);
    EXPECT_EQ(to_json_line(read), line);
    EXPECT_EQ(line.find('\n'), std::string::npos);

    EXPECT_EQ(read.frame, scene.frame);
    EXPECT_NEAR(read.t, scene.t, 1e-6);  // doubles since 1970 have steps of .24 us
    EXPECT_EQ(read.image, scene.image);
    ASSERT_EQ(read.pose.has_value(), scene.pose.has_value());
    if (scene.pose) {
      EXPECT_NEAR(read.pose->theta, scene.pose->theta, kMetric);
      EXPECT_EQ(read.pose->kind, scene.pose->kind);
      EXPECT_EQ(read.pose->mirror, scene.pose->mirror);
    }
    ASSERT_EQ(read.balls.size(), scene.balls.size());
    for (std::size_t i = 0; i < scene.balls.size(); ++i) {
      const Ball &a = read.balls[i], &b = scene.balls[i];
      EXPECT_EQ(a.box, b.box);
      expect_same(a.center, b.center);
      ASSERT_EQ(a.floor.has_value(), b.floor.has_value());
      if (!b.floor) continue;
      expect_same(a.floor->position, b.floor->position);
      expect_same(a.floor->bounds, b.floor->bounds);
    }
    ASSERT_EQ(read.goals.size(), scene.goals.size());
    for (std::size_t i = 0; i < scene.goals.size(); ++i) {
      const Goal &a = read.goals[i], &b = scene.goals[i];
      EXPECT_EQ(a.color, b.color);
      EXPECT_EQ(a.box, b.box);
      EXPECT_EQ(a.bearing.has_value(), b.bearing.has_value());
      EXPECT_EQ(a.position.has_value(), b.position.has_value());
      ASSERT_EQ(a.posts.size(), b.posts.size());
      for (std::size_t k = 0; k < b.posts.size(); ++k) {
        EXPECT_EQ(a.posts[k].side, b.posts[k].side);
        expect_same(a.posts[k].position, b.posts[k].position);
      }
    }
    ASSERT_EQ(read.robots.size(), scene.robots.size());
    for (std::size_t i = 0; i < scene.robots.size(); ++i) {
      const RobotSeen &a = read.robots[i], &b = scene.robots[i];
      EXPECT_EQ(a.team, b.team);
      EXPECT_EQ(a.box, b.box);
      ASSERT_EQ(a.floor.has_value(), b.floor.has_value());
      if (!b.floor) continue;
      expect_same(a.floor->nearest, b.floor->nearest);
      expect_same(a.floor->bounds, b.floor->bounds);
      expect_same(a.floor->center, b.floor->center);
      EXPECT_NEAR(a.floor->width, b.floor->width, kMetric);
    }
    ASSERT_EQ(read.lines.size(), scene.lines.size());
    for (std::size_t i = 0; i < scene.lines.size(); ++i) {
      const LineSeen &a = read.lines[i], &b = scene.lines[i];
      EXPECT_EQ(a.kind, b.kind);
      EXPECT_EQ(a.model, b.model);
      expect_same(a.image_q, b.image_q);
      ASSERT_EQ(a.floor.has_value(), b.floor.has_value());
      if (b.floor) expect_same(a.floor->second, b.floor->second);
    }
    ASSERT_EQ(read.circles.size(), scene.circles.size());
    ASSERT_EQ(read.free_space.has_value(), scene.free_space.has_value());
    if (scene.free_space) {
      EXPECT_EQ(read.free_space->states, scene.free_space->states);
      ASSERT_EQ(read.free_space->ranges.size(), scene.free_space->ranges.size());
      for (std::size_t i = 0; i < scene.free_space->ranges.size(); ++i)
        EXPECT_NEAR(read.free_space->ranges[i], scene.free_space->ranges[i], kMetric);
    }
    ASSERT_EQ(read.tracks.size(), scene.tracks.size());
    for (std::size_t i = 0; i < scene.tracks.size(); ++i) {
      const TrackSeen &a = read.tracks[i], &b = scene.tracks[i];
      EXPECT_EQ(a.id, b.id);
      EXPECT_EQ(a.kind, b.kind);
      EXPECT_EQ(a.team, b.team);
      EXPECT_NEAR(a.x, b.x, kMetric);
      EXPECT_NEAR(a.y, b.y, kMetric);
      EXPECT_NEAR(a.vx, b.vx, kMetric);
      EXPECT_NEAR(a.vy, b.vy, kMetric);
      EXPECT_NEAR(a.age, b.age, kMetric);
      for (std::size_t k = 0; k < 16; ++k)
        EXPECT_NEAR(a.covariance[k], b.covariance[k], 1e-8 * std::abs(b.covariance[k]));
    }
    EXPECT_EQ(read.why, scene.why);
    ASSERT_EQ(read.timing.size(), scene.timing.size());
    EXPECT_EQ(read.timing.back().stage, "total");
  }
}

TEST(SceneJson, NothingSeenIsEmptyListsAndNull) {
  Scene scene;
  scene.timing = {{"total", 1.5}};
  EXPECT_EQ(
      to_json_line(scene),
      R"({"frame":0,"t":0.0,"pose":null,"balls":[],"goals":[],"robots":[],"lines":[],"free_space":null,"tracks":[],"why":{},"timing_ms":{"total":1.5}})");
}

TEST(SceneJson, LinesFromBeforeThereWereTracksAreRead) {
  Scene scene;
  scene.timing = {{"total", 1.5}};
  std::string line = to_json_line(scene);
  const std::string tracks = R"("tracks":[],)";
  ASSERT_NE(line.find(tracks), std::string::npos);
  EXPECT_TRUE(scene_from_json(line.erase(line.find(tracks), tracks.size())).tracks.empty());
}

TEST(SceneJson, WithoutACameraFloorValuesAreNull) {
  Scene scene;
  scene.timing = {{"total", 0}};
  scene.balls = {Ball{{1, 2, 3, 4}, {2, 3}, 1, 0.5, {}}};
  scene.robots = {RobotSeen{Team::cyan, {1, 2, 3, 4}, {}}};
  scene.lines = {LineSeen{LineKind::boundary, {1, 2}, {3, 4.12345}, {}, ""}};
  const std::string line = to_json_line(scene);
  EXPECT_THAT(
      line, testing::HasSubstr(R"({"x":null,"y":null,"distance":null,"bearing":null,"near":null,"far":null,"cov":null,)"
                               R"("box":[1,2,3,4],"center":[2.0,3.0],"radius_px":1.0,"confidence":0.5})"));
  EXPECT_THAT(line,
              testing::HasSubstr(R"("near":null,"far":null,"center":null,"cov":null,"width":null,"box":[1,2,3,4]})"));
  EXPECT_THAT(line, testing::HasSubstr(
                        R"({"kind":"boundary","p":null,"q":null,"image":[[1.0,2.0],[3.0,4.123]],"model":null})"));
}

TEST(SceneJson, RoundingIsDeterministicAndKeepsSmallVariances) {
  Scene scene;
  scene.timing = {{"total", 0.12345678}};
  scene.t = 1763800000.1234567;
  Ball ball;
  ball.floor = BallOnFloor{{{-1e-9, 2.00000049}, Eigen::Matrix2d::Identity() * 1.23456789123e-9}, {1, 2}};
  scene.balls = {ball};
  const std::string line = to_json_line(scene);
  EXPECT_THAT(line, testing::HasSubstr(R"("t":1763800000.123457,)"));
  EXPECT_THAT(line, testing::HasSubstr(R"("x":0.0,"y":2.0,)"));
  EXPECT_THAT(line, testing::HasSubstr(R"("cov":[1.23456789e-09,0.0,0.0,1.23456789e-09])"));
  EXPECT_THAT(line, testing::HasSubstr(R"("total":0.1235)"));
}

TEST(SceneJson, ReasonsOfOneSubjectAreJoinedAndTimesAdded) {
  Scene scene;
  scene.why = {{"balls", "too high"}, {"pose", "none"}, {"balls", "too flat"}};
  scene.timing = {{"detect", 1}, {"detect", 2}, {"total", 4}};
  const std::string line = to_json_line(scene);
  EXPECT_THAT(line, testing::HasSubstr(R"("why":{"balls":"too high; too flat","pose":"none"})"));
  EXPECT_THAT(line, testing::HasSubstr(R"("timing_ms":{"detect":3.0,"total":4.0})"));
}

TEST(SceneJson, FileNamesThatAreNoUtf8DoNotLoseTheScene) {
  Scene scene;
  scene.timing = {{"total", 1}};
  scene.image = "caf\xe9.png";
  EXPECT_EQ(scene_from_json(to_json_line(scene)).image, "caf\xEF\xBF\xBD.png");
}

TEST(SceneJsonDeathTest, BrokenPromisesStop) {
  Scene scene;
  EXPECT_DEATH(to_json_line(scene), "a scene has its total time");
  scene.timing = {{"total", 1}};
  scene.t = std::numeric_limits<double>::quiet_NaN();
  EXPECT_DEATH(to_json_line(scene), "the numbers of a scene are finite");
  scene.t = 0;
  scene.free_space = FreeSpace{{}, 0, 1, {1, 2}, {SectorState::free}};
  EXPECT_DEATH(to_json_line(scene), "free space has a state for each range");
}

TEST(SceneJson, MalformedLinesAreRefused) {
  const std::string good =
      R"({"frame":0,"t":0.5,"pose":null,"balls":[{"x":1,"y":0,"distance":1,"bearing":0,"near":1,"far":null,"cov":[1,0,0,1],)"
      R"("box":[1,2,3,4],"center":[2,3],"radius_px":1,"confidence":0.5}],"goals":[],"robots":[],)"
      R"("lines":[{"kind":"circle","center":[0,0],"radius":1}],)"
      R"("free_space":{"origin":[0,0],"angle_min":0,"angle_increment":1,"ranges":[1,null],"state":["free","unseen"]},"why":{},"timing_ms":{"total":1}})";
  EXPECT_NO_THROW(scene_from_json(good));
  struct Case {
    std::string from, to, message;
  };
  const Case cases[] = {
      {R"("frame":0)", R"("frame":-1)", "frame is '-1', must be >= 0"},
      {R"("frame":0,)", "", "key 'frame' is missing"},
      {R"("t":0.5)", R"("t":null)", "t is empty, must be a finite number"},
      {R"("t":0.5)", R"("t":0.5,"history":[])",
       "unknown key 'history', must be frame, t, image, pose, balls, goals, robots, lines, free_space, tracks, why or "
       "timing_ms"},
      {R"("t":0.5)", R"("t":0.5,"tracks":[{"id":0}])", "tracks[0].id is '0', must be >= 1 and <= 2147483647"},
      {R"("x":1,)", R"("x":null,)", "balls[0].y is not null, must be like x"},
      {R"("near":1,)", R"("near":null,)", "balls[0].near is null, must be like x"},
      {R"("cov":[1,0,0,1])", R"("cov":[1,0,0])", "balls[0].cov has 3 values, must have 4"},
      {"[1,2,3,4]", "[1,2,3,4.5]", "balls[0].box[3] is '4.5', must be a whole number"},
      {R"("confidence":0.5)", R"("confidence":1.5)", "balls[0].confidence is '1.5', must be >= 0 and <= 1"},
      {R"("circle")", R"("square")", "lines[0].kind is 'square', must be line, boundary or circle"},
      {R"("circle")", R"("line")", "unknown key 'center', must be kind, p, q, image or model"},
      {R"("radius":1})", R"("radius":-1})", "lines[0].radius is '-1', must be >= 0"},
      {R"("unseen"])", R"("blocked"])", "free_space.ranges[1] is null, must be a number unless unseen"},
      {R"(["free")", R"(["unseen")", "free_space.ranges[0] is not null, must be where unseen"},
      {R"(["free",)", "[", "free_space.state has 1 values, must have 2"},
      {R"("why":{})", R"("why":{"pose":3})", "why.pose is '3', must be a text"},
      {R"("total":1)", R"("detect":1)", "key 'timing_ms.total' is missing"},
      {R"("total":1)", R"("total":-1)", "timing_ms.total is '-1', must be >= 0"},
  };
  for (const Case& c : cases)
    EXPECT_EQ(message_of([&] { scene_from_json(spoiled(good, c.from, c.to), "s.jsonl:7"); }),
              "s.jsonl:7: " + c.message);
}

TEST(SceneJson, FilesAreReadLineByLine) {
  const TestFolder folder;
  std::string text;
  for (unsigned seed = 0; seed < 5; ++seed) text += to_json_line(random_scene(seed)) + "\n";
  const auto scenes = read_scenes(folder.with("s.jsonl", text));
  ASSERT_EQ(scenes.size(), 5u);
  EXPECT_EQ(to_json_line(scenes[4]), to_json_line(random_scene(4)));
  const auto broken = folder.with("b.jsonl", text + "{");
  EXPECT_THAT(message_of([&] { read_scenes(broken); }), testing::StartsWith(broken.string() + ":6: is no valid JSON"));
}

}  // namespace
}  // namespace tassilo
