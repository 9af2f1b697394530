#include "tassilo/files/robot_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tassilo/files/internal/test_data.h"
#include "tassilo/files/internal/test_message.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

const std::string kFull = R"(robot: {id: 3, team: cyan}
camera: camera.yaml
colors: ../colors.yaml
field: msl98
start_pose: {x: 1.2, y: 0, theta: -3.1, sigma_xy: .2}
vision:
  field_boundary: skeleton
  ball_min_px: 12
)";

TEST(RobotFile, WrittenRobotsReadBackTheSame) {
  const std::string quoted = "vision: {a: \"12\", b: 1e-3, c: skeleton, d: true, e: \"x: #y\", f: -0.5}\n";
  for (const std::string& text : {kFull, std::string("{}"), std::string("robot: {id: 7}\nfield: fields/own.yaml\n"),
                                  "start_state: state.yaml\nplugins: [a.so, ../b c.so]\n" + quoted,
                                  std::string("bus: {domain: 7, interface: wlan0, peers: [10.0.0.2, bench], multicast: "
                                              "true, reliable: true, bytes_per_second: 1e5, picture_rate: 2.5, rates: "
                                              "{pose: 10, image/compressed: .5}}\n")}) {
    SCOPED_TRACE(text);
    const RobotFile robot = robot_from_yaml(text, "robots/r3/robot.yaml");
    const RobotFile read = robot_from_yaml(robot_yaml(robot, "robots/r3"), "robots/r3/robot.yaml");
    EXPECT_EQ(read.id, robot.id);
    EXPECT_EQ(read.team, robot.team);
    const auto normal = [](const std::optional<fs::path>& path) {
      return path ? std::optional(path->lexically_normal()) : std::nullopt;
    };
    EXPECT_EQ(normal(read.camera), normal(robot.camera));
    EXPECT_EQ(normal(read.colors), normal(robot.colors));
    EXPECT_EQ(normal(read.start_state), normal(robot.start_state));
    EXPECT_EQ(read.field, robot.field);
    EXPECT_EQ(read.bus, robot.bus);
    ASSERT_EQ(read.start_pose.has_value(), robot.start_pose.has_value());
    if (robot.start_pose) {
      EXPECT_EQ(read.start_pose->theta, robot.start_pose->theta);
      EXPECT_EQ(read.start_pose->sigma_xy, robot.start_pose->sigma_xy);
    }
    ASSERT_EQ(read.plugins.size(), robot.plugins.size());
    for (std::size_t i = 0; i < read.plugins.size(); ++i) EXPECT_EQ(normal(read.plugins[i]), normal(robot.plugins[i]));
    ASSERT_EQ(read.vision.size(), robot.vision.size());
    for (std::size_t i = 0; i < read.vision.size(); ++i) {
      EXPECT_EQ(read.vision[i].first, robot.vision[i].first);
      EXPECT_EQ(read.vision[i].second.text, robot.vision[i].second.text);
      const bool is_text = robot.vision[i].second.text == "skeleton" || robot.vision[i].second.text == "x: #y";
      EXPECT_TRUE(is_text || read.vision[i].second.quoted == robot.vision[i].second.quoted);
    }
  }
}

TEST(RobotFile, ReadsEverything) {
  const RobotFile robot = robot_from_yaml(kFull, "robots/r3/robot.yaml");
  EXPECT_EQ(robot.id, 3);
  EXPECT_EQ(robot.team, Team::cyan);
  EXPECT_EQ(robot.camera, "robots/r3/camera.yaml");
  EXPECT_EQ(robot.colors, "robots/r3/../colors.yaml");
  EXPECT_EQ(robot.field, "msl98");
  ASSERT_TRUE(robot.start_pose);
  EXPECT_EQ(robot.start_pose->theta, -3.1);
  EXPECT_EQ(robot.start_pose->sigma_xy, .2);
  EXPECT_EQ(robot.start_pose->sigma_theta, .1);
  ASSERT_EQ(robot.vision.size(), 2u);
  EXPECT_EQ(robot.vision[0].first, "field_boundary");
  EXPECT_EQ(robot.vision[0].second.text, "skeleton");
  EXPECT_EQ(robot.vision[1].second.integer(), 12);
  EXPECT_EQ(robot.vision[1].second.place, "robots/r3/robot.yaml:8:16");
  EXPECT_EQ(message_of([&] { (void)robot.vision[1].second.integer(20); }),
            "robots/r3/robot.yaml:8:16: vision.ball_min_px is '12', must be >= 20");
}

TEST(RobotFile, EverythingMayBeMissing) {
  const RobotFile robot = robot_from_yaml("vision:\n", "robot.yaml");
  EXPECT_EQ(robot.team, Team::unknown);
  EXPECT_FALSE(robot.camera || robot.colors || robot.field || robot.start_pose);
  EXPECT_TRUE(robot.vision.empty());
}

TEST(RobotFile, FieldIsANameOrAPath) {
  EXPECT_EQ(robot_from_yaml("field: my.yaml", "a/robot.yaml").field, "a/my.yaml");
  EXPECT_EQ(robot_from_yaml("field: ../my", "a/robot.yaml").field, "a/../my");
  EXPECT_EQ(robot_from_yaml("field: /abs/my.yaml", "a/robot.yaml").field, "/abs/my.yaml");
}

TEST(RobotFile, PluginsAreFilesBesideIt) {
  const RobotFile robot = robot_from_yaml("plugins: [blob.so, /abs/b.so]", "a/robot.yaml");
  EXPECT_EQ(robot.plugins, (std::vector<fs::path>{"a/blob.so", "/abs/b.so"}));
  EXPECT_TRUE(robot_from_yaml("plugins:\n", "a/robot.yaml").plugins.empty());
}

TEST(RobotFile, MalformedFilesAreRefused) {
  struct Case {
    std::string from, to, message;
  };
  const Case cases[] = {
      {"colors:", "colours:",
       "r:3:1: unknown key 'colours', must be robot, camera, colors, field, start_pose, start_state, bus, "
       "plugins or vision; did you mean colors?"},
      {"camera: camera.yaml", "bus: {domain: 233}", "r:2:15: bus.domain is '233', must be >= 0 and <= 232"},
      {"camera: camera.yaml", "bus: {rates: {pose: 0}}", "r:2:21: bus.rates.pose is '0', must be >= 0.01 and <= 1000"},
      {"id: 3", "id: 256", "r:1:13: robot.id is '256', must be >= 0 and <= 255"},
      {"id: 3", "id: -1", "r:1:13: robot.id is '-1', must be >= 0 and <= 255"},
      {"cyan", "green", "r:1:22: robot.team is 'green', must be cyan or magenta"},
      {"camera: camera.yaml", "camera:", "r:2:1: camera is empty, must be a text"},
      {"camera: camera.yaml", "camera: [a, b]", "r:2:9: camera is a list, must be a text"},
      {"camera: camera.yaml", "camera: ''", "r:2:9: camera is empty, must be a text"},
      {"y: 0, ", "", "r:5:13: key 'start_pose.y' is missing"},
      {"theta: -3.1", "theta: 90",
       "r:5:35: start_pose.theta is '90', must be >= -6.283185307179586 and <= 6.283185307179586"},
      {"sigma_xy: .2", "sigma_xy: 0", "r:5:51: start_pose.sigma_xy is '0', must be > 0"},
      {"field: msl98", "plugins: blob.so", "r:4:10: plugins is 'blob.so', must be a list"},
      {"field: msl98", "plugins: [a.so, [b.so]]", "r:4:17: plugins[1] is a list, must be a text"},
      {"skeleton", "[skeleton]", "r:7:19: vision.field_boundary is a list, must be one value"},
      {"ball_min_px", "field_boundary", "r:8:3: key 'field_boundary' appears twice, first at r:7:3"},
  };
  for (const Case& c : cases)
    EXPECT_EQ(message_of([&] { robot_from_yaml(spoiled(kFull, c.from, c.to), "r"); }), c.message);
}

TEST(RobotFile, SharedRobotsLoad) {
  if (!fs::exists(shared_data())) GTEST_SKIP() << "../shared/data is not there";
  for (const fs::path& file : files_named(shared_data(), "robot.yaml")) {
    SCOPED_TRACE(file);
    const RobotFile robot = read_robot(file);
    EXPECT_EQ(robot.id, 1);
    ASSERT_TRUE(robot.camera && robot.colors && robot.field);
    EXPECT_TRUE(fs::exists(*robot.camera));
  }
}

}  // namespace
}  // namespace tassilo
