#include "tassilo/vision/stages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

using testing::HasSubstr;
using BallFinder = std::function<BallSearch(const View&)>;
using Settings = std::vector<std::pair<std::string, Setting>>;

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// An alternative for the balls that sees none.
Alternative<BallFinder> blind(std::vector<OptionInfo> options = {}) {
  return {"blind", "sees nothing", std::move(options), [](const VisionOptions&) -> BallFinder {
            return [](const View&) { return BallSearch{{}, "blind"}; };
          }};
}

OptionInfo reach() {
  return {
      .key = "blind_reach", .unit = "m", .low = 0, .high = 9, .meaning = "how far", .standard = 2, .stage = "balls"};
}

StageRegistry with(Alternative<BallFinder> alternative) {
  StageRegistry registry = built_in_stages();
  registry.balls.alternatives.push_back(std::move(alternative));
  return registry;
}

Settings setting(const std::string& key, const std::string& text, bool quoted = false) {
  return {{key, Setting{"robot.yaml:3:10", "vision." + key, text, quoted}}};
}

TEST(CheckStages, TakesWhatIsBuiltInAndWhatFits) {
  EXPECT_NO_THROW(check_stages(built_in_stages(), "tassilo"));
  EXPECT_NO_THROW(check_stages(with(blind({reach()})), "blind.so"));
}

TEST(CheckStages, RefusesWhatDoesNotFit) {
  const auto message = [](const auto& change) {
    Alternative<BallFinder> alternative = blind({reach()});
    change(alternative);
    return message_of([&] { check_stages(with(alternative), "blind.so"); });
  };
  EXPECT_EQ(message([](auto& a) { a.name = "sphere"; }), "blind.so: alternative 'balls: sphere' exists already");
  for (const char* name : {"", "Blind", "blind ball", "blind-ball"})
    EXPECT_THAT(message([&](auto& a) { a.name = name; }), HasSubstr("must be named by a-z, 0-9 and _")) << name;
  EXPECT_EQ(message([](auto& a) { a.make = nullptr; }), "blind.so: alternative 'balls: blind' has no `make`");
  for (const char* key : {"ball_max", "localization"})
    EXPECT_EQ(message([&](auto& a) { a.options[0].key = key; }),
              "blind.so: option '" + std::string(key) + "' exists already");
  EXPECT_THAT(message([](auto& a) { a.options.push_back(reach()); }), HasSubstr("'blind_reach' exists already"));
  EXPECT_THAT(message([](auto& a) { a.options[0].key = "Reach"; }), HasSubstr("must be named by a-z, 0-9 and _"));
  for (const double standard : {-0.1, 9.1, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(message([&](auto& a) { a.options[0].standard = standard; }),
              "blind.so: option 'blind_reach' must have -1e9 <= low <= default <= high <= 1e9");
}

TEST(StageChoice, IsReadByName) {
  const StageRegistry registry = with(blind());
  const VisionOptions options = vision_options(setting("balls", "blind"), registry);
  EXPECT_EQ(options.stages.at("balls"), "blind");
  EXPECT_EQ(vision_options(setting("balls", "blind", true), registry).stages, options.stages) << "in quotes";
  EXPECT_TRUE(vision_options(Settings{}, registry).stages.empty());
}

TEST(StageChoice, RefusesNamesThatAreNone) {
  EXPECT_EQ(
      message_of([] { vision_options(setting("field_boundary", "skeletom")); }),
      "robot.yaml:3:10: vision.field_boundary is 'skeletom', must be subpixel or skeleton; did you mean skeleton?");
  EXPECT_EQ(message_of([] { vision_options(setting("balls", "3")); }),
            "robot.yaml:3:10: vision.balls is '3', must be sphere");
  EXPECT_THAT(message_of([] { vision_options(setting("boundary", "skeleton")); }), HasSubstr("unknown key"));
  VisionOptions options;
  options.stages["balls"] = "none";
  EXPECT_EQ(message_of([&] { chosen_stages(built_in_stages(), options); }), "vision.balls: is 'none', must be sphere");
}

TEST(StageChoice, MakesEveryAlternative) {
  for (const StageInfo& stage : stage_infos(built_in_stages()))
    for (const auto& alternative : stage.alternatives) {
      SCOPED_TRACE(std::string(stage.key) + ": " + alternative.name);
      const VisionOptions options = vision_options(setting(std::string(stage.key), alternative.name));
      const Stages stages = chosen_stages(built_in_stages(), options);
      EXPECT_TRUE(stages.balls && stages.goals && stages.robots && stages.lines && stages.free_space);
      EXPECT_TRUE(stages.field_boundary && stages.localization.run);
    }
}

TEST(OwnOptions, HaveTheirDefaultUntilSet) {
  OptionInfo count = reach();
  count.key = "blind_count";
  count.whole = true;
  const StageRegistry registry = with(blind({reach(), count}));
  const std::map<std::string, double, std::less<>> standard{{"blind_reach", 2}, {"blind_count", 2}};
  EXPECT_EQ(vision_options(Settings{}, registry).own, standard);
  EXPECT_EQ(vision_options(setting("blind_reach", "3.5"), registry).own.at("blind_reach"), 3.5);
  EXPECT_EQ(vision_options(setting("blind_count", "3"), registry).own.at("blind_count"), 3);
}

TEST(OwnOptions, AreBoundedAndTheirRegistrysOnly) {
  OptionInfo count = reach();
  count.whole = true;
  const StageRegistry registry = with(blind({count}));
  for (const char* text : {"-1", "10", "3.5", "many", "nan"})
    EXPECT_THAT(message_of([&] { vision_options(setting("blind_reach", text), registry); }),
                HasSubstr("robot.yaml:3:10: vision.blind_reach is '" + std::string(text) + "', must be"));
  EXPECT_THAT(message_of([&] { vision_options(setting("blind_reech", "1"), registry); }),
              HasSubstr("did you mean 'blind_reach'"));
  EXPECT_THAT(message_of([] { vision_options(setting("blind_reach", "1")); }), HasSubstr("unknown key"));
}

// What `make` is given is what was set.
TEST(OwnOptions, ReachTheirAlternative) {
  Alternative<BallFinder> alternative = blind({reach()});
  double seen = 0;
  alternative.make = [&seen](const VisionOptions& options) -> BallFinder {
    seen = options.own.at("blind_reach");
    return [](const View&) { return BallSearch{}; };
  };
  const StageRegistry registry = with(alternative);
  Settings settings = setting("balls", "blind");
  settings.push_back(setting("blind_reach", "7").front());
  chosen_stages(registry, vision_options(settings, registry));
  EXPECT_EQ(seen, 7);
}

TEST(StageInfos, HoldEveryOptionOnceAndEveryAlternative) {
  const std::vector<StageInfo> infos = stage_infos(with(blind({reach()})));
  std::map<std::string, int> options;
  std::map<std::string_view, std::vector<std::string>> alternatives;
  for (const StageInfo& stage : infos) {
    EXPECT_FALSE(stage.meaning.empty()) << stage.key;
    EXPECT_FALSE(alternatives.contains(stage.key)) << stage.key << " is there twice";
    alternatives[stage.key] = {};
    for (const OptionInfo& option : stage.options) {
      ++options[option.key];
      EXPECT_EQ(option.stage, stage.key) << option.key;
      EXPECT_FALSE(option.meaning.empty() || option.unit.empty()) << option.key;
    }
    for (const auto& alternative : stage.alternatives) {
      alternatives[stage.key].push_back(alternative.name);
      EXPECT_FALSE(alternative.meaning.empty()) << alternative.name;
      for (const OptionInfo& option : alternative.options) ++options[option.key];
    }
  }
  std::map<std::string, int> expected{{"blind_reach", 1}};
  for (const OptionInfo& option : vision_option_infos()) expected[option.key] = 1;
  EXPECT_EQ(options, expected);
  EXPECT_EQ(alternatives.at("balls"), (std::vector<std::string>{"sphere", "blind"}));
  EXPECT_EQ(alternatives.at("localization"), (std::vector<std::string>{"model", "boundary"}));
  with(blind()).for_each([&](const auto& stage) { EXPECT_TRUE(alternatives.contains(stage.key)) << stage.key; });
}

}  // namespace
}  // namespace tassilo
