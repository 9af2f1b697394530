#include "tassilo/sim/truth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tassilo/camera/test_world.h"
#include "tassilo/files/document.h"
#include "tassilo/files/field_file.h"
#include "tassilo/files/json.h"

namespace tassilo {
namespace {

constexpr int kMe = 1;

SimState state() {
  SimState s;
  s.ball = {.at = {1.5, .2}, .vx = .1, .radius = .1};
  s.robots.push_back({.id = kMe, .team = Team::cyan, .at = {0, 0}, .theta = 0, .speed = .5, .turn = -.2});
  s.robots.push_back({.id = 2, .team = Team::magenta, .at = {2, -.3}, .theta = 1, .radius = .2, .height = .5});
  return s;
}

TEST(TrueFreeSpace, MeasuresWallsGoalsAndRobots) {
  const FieldModel field = read_field("msl98");
  const TrueFreeSpace free = true_free_space(field, state(), kMe, {0, 0});
  EXPECT_EQ(free.hit[0], "goal_blue");
  EXPECT_NEAR(*free.ray[0], 4.11 + .5, 1e-9) << "past the robot, through the mouth";
  EXPECT_EQ(free.hit[18], "goal_yellow");
  EXPECT_EQ(free.hit[9], "wall");
  EXPECT_NEAR(*free.ray[9], 2.2875, 1e-9);
  EXPECT_EQ(free.hit[35], "robot0");
  const double off = 2 * std::sin(std::numbers::pi / 18) - .3 * std::cos(std::numbers::pi / 18);
  EXPECT_NEAR(*free.ray[35],
              2 * std::cos(std::numbers::pi / 18) + .3 * std::sin(std::numbers::pi / 18) - std::sqrt(.04 - off * off),
              1e-9);
  for (std::size_t k = 0; k < free.ray.size(); ++k) EXPECT_LE(*free.least[k], *free.ray[k]);
}

TEST(TrueFreeSpace, EndsNowhereWithoutWalls) {
  const TrueFreeSpace free = true_free_space(read_field("spl"), state(), kMe, {0, 0});
  EXPECT_EQ(free.hit[9], "none");
  EXPECT_FALSE(free.ray[9]);
}

TEST(TruthLines, SayWhatIsTrue) {
  const FieldModel field = read_field("msl98");
  const MountedCamera camera = test::cameras()[0];
  Renderer renderer(field, camera, plain_rendering());
  const SimView& view = renderer.look(state(), kMe);
  TruthOfFrame frame;
  frame.frame = 3;
  frame.lamps = {{.intensity = .5}};
  const std::string line = TruthLines(field, camera).line(state(), kMe, view, frame);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const Map map = parse_json(line, "truth").any_map();
  EXPECT_EQ(map.at("frame").integer(), 3);
  const Map ball = map.at("ball").any_map();
  EXPECT_NEAR(ball.at("rx").number(), 1.5, 1e-6);
  EXPECT_NEAR(ball.at("dist").number(), std::hypot(1.5, .2), 1e-6);
  const auto center = camera.project({1.5, .2, .1});
  EXPECT_NEAR(ball.at("center_px").numbers(2)[0], center->x, 1e-3);
  EXPECT_EQ(ball.at("visible_px").integer(), view.ball.visible_px);
  const auto box = ball.at("bbox").numbers(4);
  EXPECT_TRUE(box[0] < center->x && box[2] > center->x && box[1] < center->y && box[3] > center->y);
  const Map free = map.at("free").any_map().at("camera").any_map();
  EXPECT_NEAR(free.at("origin").numbers(2)[0], camera.mount().x, 1e-6);
}

}  // namespace
}  // namespace tassilo
