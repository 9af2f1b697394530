#include "tassilo/files/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tassilo/files/internal/test_message.h"
#include "tassilo/files/json.h"
#include "tassilo/files/yaml.h"

namespace tassilo {
namespace {

using testing::ElementsAre;

TEST(Yaml, ValuesKnowTheirPlaceAndName) {
  const Value root = parse_yaml("robot: {id: 3}\nboxes:\n  - [1, 2]\n  - [3, x]\n", "a.yaml");
  const Map map = root.map({"robot", "boxes", "field"});
  EXPECT_EQ(map.at("robot").map({"id"}).at("id").integer(), 3);
  EXPECT_EQ(map.at("robot").map({"id"}).at("id").place(), "a.yaml:1:13");
  EXPECT_FALSE(map.find("field"));
  const auto boxes = map.at("boxes").list();
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_EQ(boxes[1].line(), 4);
  EXPECT_THAT(boxes[0].numbers(2), ElementsAre(1, 2));
  EXPECT_EQ(message_of([&] { boxes[1].numbers(2); }), "a.yaml:4:9: boxes[1][1] is 'x', must be a finite number");
}

TEST(Yaml, OrderOfEntriesIsThatOfTheFile) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : parse_yaml("{z: 1, a: 2, m: 3}", "a").any_map().entries())
    keys.push_back(key + value.setting().text);
  EXPECT_THAT(keys, ElementsAre("z1", "a2", "m3"));
}

TEST(Yaml, MalformedTextsAreRefusedWithTheirPlace) {
  struct Case {
    std::string text, message;
  };
  const Case cases[] = {
      {"", "a.yaml: is empty"},
      {"# nothing\n", "a.yaml: is empty"},
      {"a: [1, 2", "a.yaml:1:1: is no valid YAML: end of sequence flow not found"},
      {"a: 1\na: 2\n", "a.yaml:2:1: key 'a' appears twice, first at a.yaml:1:1"},
      {"x: {b: 1, c: 2, b: 3}", "a.yaml:1:17: key 'b' appears twice, first at a.yaml:1:5"},
      {"a: &x [1]\nb: *x\n", "a.yaml:2:4: an alias (*name) stands here, must be written out"},
      {"a: !!str 3", "a.yaml:1:4: a tag 'tag:yaml.org,2002:str' stands here, must be a plain value"},
      {"a: 1\n---\nb: 2\n", "a.yaml:2:1: a second document begins, must be one only"},
      {"? [1]\n: 2", "a.yaml:1:3: a key is a list or a map, must be a name"},
      {"~: 2", "a.yaml:1:1: a key is empty, must be a name"},
      {"a: " + std::string(40, '[') + std::string(40, ']'), "a.yaml:1:35: is nested deeper than 32 levels"},
      {"a:\tb:\t- c: \"\x01", "a.yaml"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    EXPECT_THAT(message_of([&] { parse_yaml(c.text, "a.yaml"); }), testing::StartsWith(c.message));
  }
}

TEST(Yaml, AliasBombsAndDeepNestingStayCheap) {
  std::string bomb = "a0: &a0 [x, x]\n";
  for (int i = 1; i < 40; ++i) {
    const std::string before = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before + ", " + before + "]\n";
  }
  EXPECT_THROW(parse_yaml(bomb, "a"), Error);
  EXPECT_THROW(parse_yaml(std::string(1 << 20, '['), "a"), Error);
  EXPECT_THROW(parse_yaml(std::string(1 << 20, '{'), "a"), Error);
  std::string compact, indented;
  for (int i = 0; i < 2000; ++i) compact += "- ", indented += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  EXPECT_THROW(parse_yaml(compact, "a"), Error);
  EXPECT_THROW(parse_yaml(indented, "a"), Error);
  EXPECT_THROW(parse_yaml(std::string((1 << 20) + 1, ' '), "a"), Error);
}

TEST(Value, WrongKindsSayWhatItIsAndMustBe) {
  const Value root = parse_yaml("{list: [1], map: {k: v}, text: t, none: , quoted: '1', file: \"a\\tb\"}", "a");
  const Map map = root.map({"list", "map", "text", "none", "quoted", "file"});
  struct Case {
    std::function<void()> read;
    std::string message;
  };
  const Case cases[] = {
      {[&] { root.list(); }, "a:1:1: is a map, must be a list"},
      {[&] { map.at("list").any_map(); }, "a:1:8: list is a list, must be a map"},
      {[&] { map.at("map").number(); }, "a:1:18: map is a map, must be a finite number"},
      {[&] { map.at("none").number(); }, "a:1:35: none is empty, must be a finite number"},
      {[&] { map.at("none").string(); }, "a:1:35: none is empty, must be a text"},
      {[&] { map.at("list").string(); }, "a:1:8: list is a list, must be a text"},
      {[&] { map.at("list").integer(); }, "a:1:8: list is a list, must be a whole number"},
      {[&] { map.at("list").boolean(); }, "a:1:8: list is a list, must be true or false"},
      {[&] { map.at("list").setting(); }, "a:1:8: list is a list, must be one value"},
      {[&] { map.at("list").list(2); }, "a:1:8: list has 1 values, must have at least 2"},
      {[&] { map.at("list").list(2, 3); }, "a:1:8: list has 1 values, must have 2 to 3"},
      {[&] { map.at("list").numbers(4); }, "a:1:8: list has 1 values, must have 4"},
      {[&] { map.at("quoted").number(); }, "a:1:51: quoted is the text '1', must be a finite number"},
      {[&] { map.at("file").path("."); }, "a:1:62: file is 'a?b', must be a file name"},
      {[&] { map.at("other"); }, "a:1:1: key 'other' is missing"},
      {[&] { map.at("map").map({"key"}).at("j"); }, "a:1:19: unknown key 'k', must be key"},
      {[&] {
         map.at("map").map({"k", "j"}).at("j");
       },
       "a:1:18: key 'map.j' is missing"},
      {[&] {
         root.map({"lists", "map", "text", "none", "quoted", "file"});
       },
       "a:1:2: unknown key 'list', must be lists, map, text, none, quoted or file; did you mean lists?"},
  };
  for (const Case& c : cases) EXPECT_EQ(message_of(c.read), c.message);
}

TEST(Value, PathsAreRelativeToTheirFolder) {
  const Map map = parse_yaml("{a: x/y.png, b: /abs.png}", "a").any_map();
  EXPECT_EQ(map.at("a").path("base"), "base/x/y.png");
  EXPECT_EQ(map.at("b").path("base"), "/abs.png");
}

TEST(Json, StrictlyTyped) {
  const Map map = parse_json(R"({"n": 1.5, "i": -2, "t": "3", "b": true, "z": null})", "s:4").any_map();
  EXPECT_EQ(map.at("n").number(), 1.5);
  EXPECT_EQ(map.at("i").integer(), -2);
  EXPECT_EQ(map.at("t").string(), "3");
  EXPECT_TRUE(map.at("b").boolean());
  EXPECT_TRUE(map.at("z").is_null());
  EXPECT_EQ(message_of([&] { map.at("t").number(); }), "s:4: t is the text '3', must be a finite number");
  EXPECT_EQ(message_of([&] { map.at("n").string(); }), "s:4: n is '1.5', must be a text");
  EXPECT_EQ(message_of([&] { map.at("b").number(); }), "s:4: b is 'true', must be a finite number");
}

TEST(Json, MalformedTextsAreRefused) {
  struct Case {
    std::string text, message;
  };
  const Case cases[] = {
      {"", "s:1: is no valid JSON at character 1, near ''"},
      {"{\"a\": }", "s:1: is no valid JSON at character 7, near '\"a\": }'"},
      {"{} x", "s:1: is no valid JSON at character 4, near '{} x'"},
      {"{\"a\": 1, \"a\": 2}", "s:1: key 'a' appears twice, first at s:1"},
      {"[1e999]", "s:1: is no valid JSON at character 6, near '1e999'"},
      {"[NaN]", "s:1: is no valid JSON at character 2, near '[N'"},
      {"\"\xff\"", "s:1: is no valid JSON"},
      {std::string(100000, '['), "s:1: is nested deeper than 32 levels"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text.substr(0, 100));
    EXPECT_THAT(message_of([&] { parse_json(c.text, "s:1"); }), testing::StartsWith(c.message));
  }
}

}  // namespace
}  // namespace tassilo
