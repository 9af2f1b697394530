#include "tassilo/files/field_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tassilo/files/internal/test_data.h"
#include "tassilo/files/internal/test_message.h"
#include "tassilo/files/test_folder.h"

namespace tassilo {
namespace {

namespace fs = std::filesystem;

const fs::path kConfig = fs::path(TASSILO_SOURCE_DIR) / "config";

TEST(FieldFile, EveryShippedFieldLoads) {
  const std::vector<fs::path> folders{kConfig};
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kConfig / "fields")) {
    SCOPED_TRACE(entry.path());
    const std::string name = entry.path().stem();
    names.push_back(name);
    EXPECT_EQ(read_field(name, folders), read_field(entry.path().string(), folders));
    EXPECT_EQ(read_field(name, folders).name, name);
  }
  EXPECT_THAT(names, testing::IsSupersetOf(
                         {"msl98", "msl9x5", "msl", "spl", "humanoid_kid", "rcj_soccer", "rcj_soccer_walls", "ssl"}));
}

TEST(FieldFile, WrittenFieldsReadBackTheSame) {
  for (const auto& entry : fs::directory_iterator(kConfig / "fields")) {
    SCOPED_TRACE(entry.path());
    FieldModel field = read_field(entry.path().string());
    EXPECT_EQ(field_from_yaml(field_yaml(field), entry.path()), field);
    field.length += 1e-15 * field.length;
    field.arcs.push_back({0.1, -0.2, 1. / 3, -1, 2});
    field.segments.push_back({-1. / 7, 0, 1, 2});
    EXPECT_EQ(field_from_yaml(field_yaml(field), entry.path()), field);
  }
}

TEST(FieldFile, WalledFieldsHaveTheDimensionsOfTheRecordings) {
  const FieldModel msl98 = read_field("msl98");
  EXPECT_EQ(msl98.length, 8.22);
  EXPECT_EQ(msl98.width, 4.575);
  EXPECT_EQ(msl98.line_width, 0.035);
  EXPECT_EQ(msl98.circle_radius, 1.0);
  EXPECT_EQ(msl98.areas, (std::vector<FieldModel::Area>{{1.0, 2.6}}));
  EXPECT_EQ(msl98.goals, (std::vector<FieldModel::Goal>{{GoalSide::plus_x, GoalColor::blue, 1.5, 0.9, 0.5},
                                                        {GoalSide::minus_x, GoalColor::yellow, 1.5, 0.9, 0.5}}));
  EXPECT_EQ(msl98.walls, (FieldModel::Walls{"white", 0.5, {-4.11, 4.11}, {-2.2875, 2.2875}}));
  const FieldModel msl9x5 = read_field("msl9x5");
  EXPECT_EQ(msl9x5.length, 9.0);
  EXPECT_EQ(msl9x5.areas, (std::vector<FieldModel::Area>{{1.2, 3.0}}));
  EXPECT_EQ(msl9x5.goals[0].width, 2.0);
}

TEST(FieldFile, WallsAreTheOnlyDifferenceOfTheJuniorFields) {
  FieldModel walled = read_field("rcj_soccer_walls");
  ASSERT_TRUE(walled.walls);
  walled.walls.reset();
  walled.name = "rcj_soccer";
  EXPECT_EQ(walled, read_field("rcj_soccer"));
}

TEST(FieldFile, DefaultsAreThoseOfTheModel) {
  FieldModel expected;
  expected.name = "my";
  expected.length = 4;
  expected.width = 3;
  EXPECT_EQ(field_from_yaml("{length: 4, width: 3}", "fields/my.yaml"), expected);
}

TEST(FieldFile, ShippedNamesAreLookedUpInOrder) {
  const TestFolder folder;
  fs::create_directories(folder / "a/fields");
  fs::create_directories(folder / "b/fields");
  folder.with("a/fields/one.yaml", "{length: 4, width: 3}");
  folder.with("b/fields/one.yaml", "{length: 5, width: 3}");
  folder.with("b/fields/two.yaml", "{length: 6, width: 3}");
  const std::vector<fs::path> folders{folder / "none", folder / "a", folder / "b"};
  EXPECT_EQ(read_field("one", folders).length, 4);
  EXPECT_EQ(read_field("two", folders).length, 6);
  EXPECT_EQ(message_of([&] { read_field("tow", folders); }),
            "field 'tow': is no shipped field, must be one or two, or a path that ends in .yaml; did you mean two?");
  ASSERT_EQ(setenv("TASSILO_CONFIG_DIR", (folder / "b").c_str(), 1), 0);
  EXPECT_EQ(config_folders().front(), folder / "b");
  EXPECT_EQ(read_field("one").length, 5);
  EXPECT_EQ(read_field("msl98").length, 8.22) << "what is not there is looked for further on";
  unsetenv("TASSILO_CONFIG_DIR");
}

TEST(FieldFile, AFolderIsSearchedOnceHoweverItIsSpelled) {
  unsetenv("TASSILO_CONFIG_DIR");
  const std::vector<fs::path> shipped = config_folders();
  const fs::path again = shipped.back() / "fields" / "..";
  ASSERT_EQ(setenv("TASSILO_CONFIG_DIR", again.c_str(), 1), 0);
  const std::vector<fs::path> folders = config_folders();
  EXPECT_EQ(folders.front(), again);
  EXPECT_EQ(folders.size(), shipped.size());
  unsetenv("TASSILO_CONFIG_DIR");
}

TEST(FieldFile, MalformedFilesAreRefused) {
  const std::string good = R"(length: 8
width: 4
touchlines: true
areas: [{depth: 1, width: 2}]
segments: [[0, 0, 1, 1]]
goals: [{side: +x, color: blue, width: 1.5, height: 0.9, depth: 0.5}]
walls: {color: white, height: 0.5, x: [-4, 4], y: [-2, 2]}
ball: {color: red, radius: [0.1, 0.11]}
robots: {width: [0.3, 0.6], body: black, markers: [cyan]}
)";
  EXPECT_NO_THROW(field_from_yaml(good, "f.yaml"));
  struct Case {
    std::string from, to, message;
  };
  const Case cases[] = {
      {"length: 8\n", "", "f.yaml:1:1: key 'length' is missing"},
      {"length: 8", "length: 8 m", "f.yaml:1:9: length is '8 m', must be a finite number"},
      {"length: 8", "length: 8000", "f.yaml: field.length: is 8000, must be > 0 and <= 200 [m]"},
      {"length: 8", "length: .nan", "f.yaml:1:9: length is '.nan', must be a finite number"},
      {"width: 4", "width: 4\nwidth: 5", "f.yaml:3:1: key 'width' appears twice, first at f.yaml:2:1"},
      {"touchlines: true", "touchline: true",
       "f.yaml:3:1: unknown key 'touchline', must be length, width, line_width, halfway_line, touchlines, "
       "circle_radius, areas, "
       "segments, arcs, goals, walls, ball or robots; did you mean touchlines?"},
      {"touchlines: true", "touchlines: yes", "f.yaml:3:13: touchlines is 'yes', must be true or false"},
      {"depth: 1,", "", "f.yaml:4:9: key 'areas[0].depth' is missing"},
      {"[{depth: 1, width: 2}]", "{depth: 1, width: 2}", "f.yaml:4:8: areas is a map, must be a list"},
      {"[[0, 0, 1, 1]]", "[[0, 0, 1]]", "f.yaml:5:12: segments[0] has 3 values, must have 4"},
      {"+x", "left", "f.yaml:6:16: goals[0].side is 'left', must be +x or -x"},
      {"color: blue", "color: green", "f.yaml:6:27: goals[0].color is 'green', must be yellow or blue"},
      {"color: white", "color: whit",
       "f.yaml:7:16: walls.color is 'whit', must be black, white, green, blue, cyan, magenta, red or yellow; did you "
       "mean white?"},
      {"x: [-4, 4]", "x: [4, -4]", "f.yaml: field.walls.x: is [4, -4], must be [low, high] with low < high"},
      {"color: red", "color: no_color",
       "f.yaml:8:15: ball.color is 'no_color', must be black, white, green, blue, cyan, magenta, red or yellow"},
      {"[0.1, 0.11]", "0.1", "f.yaml:8:28: ball.radius is '0.1', must be a list"},
      {"[cyan]", "[cyan, pink]",
       "f.yaml:9:58: robots.markers[1] is 'pink', must be black, white, green, blue, cyan, magenta, red or yellow"},
  };
  for (const Case& c : cases)
    EXPECT_EQ(message_of([&] { field_from_yaml(spoiled(good, c.from, c.to), "f.yaml"); }), c.message);
  EXPECT_EQ(message_of([] { read_field("fields/none.yaml"); }),
            "fields/none.yaml: cannot be opened: No such file or directory");
}

TEST(FieldFile, SharedFieldLoads) {
  const fs::path file = shared_data() / "ssl_onboard/field.yaml";
  if (!fs::exists(file)) GTEST_SKIP() << "../shared/data is not there";
  const FieldModel field = read_field(file.string());
  EXPECT_EQ(field.segments.size(), 8u);
  EXPECT_EQ(field.walls->x, (Interval{-0.3, 4.2}));
  EXPECT_TRUE(field.goals.empty());
}

}  // namespace
}  // namespace tassilo
