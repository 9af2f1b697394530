// Every alternative of every stage, exchanged in the middle of a recording: from then on the scenes are those of a run
// that had it from the start, given the same history. So no stage keeps anything of its own.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "support/recording.h"
#include "tassilo/files/odometry_file.h"
#include "tassilo/files/scene_json.h"

namespace tassilo {
namespace {

/// Stages that Tassilo knows one way of get a second one here: something simple that shows in the scene.
StageRegistry with_test_alternatives() {
  StageRegistry all = built_in_stages();
  all.balls.alternatives.push_back({"none", "no ball, ever", {}, [](const VisionOptions&) {
                                      return [](const View&) { return BallSearch{.balls = {}, .why = "none wanted"}; };
                                    }});
  all.goals.alternatives.push_back(
      {"none", "no goal, ever", {}, [](const VisionOptions&) { return [](const View&) { return GoalSearch{}; }; }});
  all.robots.alternatives.push_back({"none", "no robot, ever", {}, [](const VisionOptions&) {
                                       return [](const View&) { return RecycledVector<RobotSeen>{}; };
                                     }});
  all.lines.alternatives.push_back(
      {"boundary_only", "without the lines of the field", {}, [](const VisionOptions& o) {
         return [line = o.line](const View& view) {
           Lines lines = find_lines(view, line);
           std::erase_if(lines.marks, [](const LineMark& mark) { return mark.kind != LineKind::boundary; });
           return lines;
         };
       }});
  all.free_space.alternatives.push_back({"careful", "half as far", {}, [](const VisionOptions&) {
                                           return [](const SectorMap& map, const Surface& surface,
                                                     std::span<const Ball> balls) {
                                             FreeSpace space = find_free_space(map, surface, balls);
                                             for (double& range : space.ranges) range /= 2;
                                             return space;
                                           };
                                         }});
  return all;
}

std::string line_without_times(Scene scene) {
  scene.timing.clear();
  scene.timing.push_back({"total", 0});
  return to_json_line(scene);
}

class Exchange : public testing::Test {
 protected:
  Exchange() {
    const std::string folder = std::string(TASSILO_SOURCE_DIR) + "/data/msl98/d01_approach";
    for (const OdometrySample& sample : read_odometry(folder + "/odometry.jsonl")) odometry.add(sample);
  }
  Vision vision_with(const std::string& stage, const std::string& name) const {
    VisionSetup setup = recording.setup;
    setup.options.stages["localization"] = stage == "field_boundary" ? "boundary" : "model";
    setup.options.stages[stage] = name;
    return Vision(setup, registry);
  }

  const test::Recording recording = test::load_recording("d01_approach", "train_div/samples.yaml");
  const StageRegistry registry = with_test_alternatives();
  Odometry odometry;
};

TEST_F(Exchange, TheScenesAfterItAreThoseOfARunThatHadItFromTheStart) {
  const std::size_t middle = recording.frames.size() / 2;
  ASSERT_GE(middle, 5u);
  registry.for_each([&](const auto& stage) {
    ASSERT_GE(stage.alternatives.size(), 2u) << stage.key;
    for (const auto& later : stage.alternatives) {
      const Vision wanted = vision_with(std::string(stage.key), later.name);
      // A run that has it from the start.
      VisionWorkspace always;
      VisionHistory history;
      std::vector<std::string> expected;
      for (std::size_t k = 0; k < recording.frames.size(); ++k) {
        if (k == middle) history = always.history;
        expected.push_back(line_without_times(wanted(recording.frames[k], always, &odometry)));
      }
      for (const auto& first : stage.alternatives) {
        if (first.name == later.name) continue;
        SCOPED_TRACE(std::string(stage.key) + ": " + first.name + ", then " + later.name);
        const Vision before = vision_with(std::string(stage.key), first.name);
        VisionWorkspace workspace;
        bool differed = false;
        for (std::size_t k = 0; k < middle; ++k)
          differed |= line_without_times(before(recording.frames[k], workspace, &odometry)) != expected[k];
        EXPECT_TRUE(differed) << "two alternatives should differ";
        workspace.history = history;
        for (std::size_t k = middle; k < recording.frames.size(); ++k)
          EXPECT_EQ(line_without_times(wanted(recording.frames[k], workspace, &odometry)), expected[k]) << k;
      }
    }
  });
}

// Without another's history, too: where the robot is, is not forgotten by a change of the way to find out.
TEST_F(Exchange, ThePoseGoesOnFromOneLocalizationToTheOther) {
  const Vision model = vision_with("localization", "model"), boundary = vision_with("localization", "boundary");
  VisionWorkspace workspace;
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    const Scene scene = (k / 5 % 2 == 0 ? model : boundary)(recording.frames[k], workspace, &odometry);
    ASSERT_TRUE(scene.pose) << k;
    EXPECT_FALSE(scene.pose->mirror);
    EXPECT_EQ(scene.pose->kind == PoseKind::model, k / 5 % 2 == 0) << k;
  }
}

}  // namespace
}  // namespace tassilo
