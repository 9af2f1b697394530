#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tassilo/detect/ball.h"
#include "tassilo/detect/goal.h"
#include "tassilo/detect/line.h"
#include "tassilo/detect/robot.h"
#include "tassilo/freespace/free_space.h"
#include "tassilo/localize/boundary.h"
#include "tassilo/localize/localize.h"
#include "tassilo/vision/options.h"

// The stages of the vision that can be done in more than one way. Which way is chosen by name in robot.yaml, and may be
// exchanged between two frames. What ties the stages together, and their order, is in vision.cpp.
//
// To add an alternative:
//   1. write a function of the stage's signature; what it needs from other frames comes in (a belief, a motion) and
//      goes out, it keeps nothing;
//   2. add its name, one line of meaning and a `make` in stages.cpp, or in a shared library (examples/plugin);
//   3. add it to the tests of stages_test.cpp, which exchange all alternatives in the middle of a recording.

namespace tassilo {

/// What the pose is found from. Borrowed for one call.
struct LocalizationInput {
  const View& view;
  const FieldTarget& target;
  const PoseBelief& before;
  const RobotMotion& motion;  ///< Since then.
  PoseObservation seen;
  const Boundary* boundary = nullptr;  ///< Only for alternatives that ask for it.
  double t = 0;                        ///< Capture time. [s]
};

/// A way to find the pose.
struct Localizer {
  std::function<Localized(const LocalizationInput&)> run;
  bool needs_boundary = false;
  bool needs_walls = false;  ///< Refused on fields without.
};

/// One way to do a stage.
template <class Function>
struct Alternative {
  std::string name;                 ///< In robot.yaml: lower case, digits, underscores.
  std::string meaning;              ///< One line for people.
  std::vector<OptionInfo> options;  ///< Keys that only this alternative reads, from VisionOptions::own.
  /// Called once a configuration; what it returns is called once a frame, by one thread at a time per workspace, and
  /// must not depend on earlier calls. Throws Error when the options do not fit together.
  std::function<Function(const VisionOptions&)> make;
};

/// A stage and its alternatives, the default first.
template <class Function>
struct Stage {
  std::string_view key;  ///< Below `vision:` in robot.yaml.
  std::string_view meaning;
  std::vector<Alternative<Function>> alternatives;
};

/// All stages with alternatives, in the order they run.
struct StageRegistry {
  Stage<std::function<BallSearch(const View&)>> balls;
  Stage<std::function<GoalSearch(const View&)>> goals;
  Stage<std::function<RecycledVector<RobotSeen>(const View&)>> robots;
  Stage<std::function<Lines(const View&)>> lines;
  Stage<std::function<FreeSpace(const SectorMap&, const Surface&, std::span<const Ball>)>> free_space;
  Stage<std::function<Boundary(const View&)>> field_boundary;  ///< Only with a mounted camera.
  Stage<Localizer> localization;

  /// Calls visit(stage) for each.
  template <class Visit>
  void for_each(Visit visit) const {
    visit(balls), visit(goals), visit(robots), visit(lines), visit(free_space), visit(field_boundary);
    visit(localization);
  }
};

/// The alternatives that Tassilo comes with.
StageRegistry built_in_stages();

/// Throws Error naming `source` when a name is none or taken twice, an option's key is taken, or a `make` is missing.
void check_stages(const StageRegistry& registry, const std::string& source);

/// The name of a stage's chosen alternative, whether it has one of that name or not: what the options say, else the
/// first. Of a Stage or a StageInfo that has alternatives.
template <class AnyStage>
const std::string& chosen_name(const AnyStage& stage, const VisionOptions& options) {
  const auto entry = options.stages.find(stage.key);
  return entry != options.stages.end() ? entry->second : stage.alternatives.front().name;
}

/// The chosen alternative of each stage.
struct Stages {
  std::function<BallSearch(const View&)> balls;
  std::function<GoalSearch(const View&)> goals;
  std::function<RecycledVector<RobotSeen>(const View&)> robots;
  std::function<Lines(const View&)> lines;
  std::function<FreeSpace(const SectorMap&, const Surface&, std::span<const Ball>)> free_space;
  std::function<Boundary(const View&)> field_boundary;
  Localizer localization;
};
/// Throws Error naming a stage whose chosen name is not among its alternatives.
Stages chosen_stages(const StageRegistry& registry, const VisionOptions& options);

/// What people may want to know of a stage.
struct StageInfo {
  std::string_view key, meaning;
  struct Alternative {
    std::string name, meaning;
    std::vector<OptionInfo> options;  ///< That it alone reads.
  };
  std::vector<Alternative> alternatives;  ///< The default first; none where a stage has one way only.
  std::vector<OptionInfo> options;        ///< Of the stage.
};
/// All stages of the vision in their order, those with one way only included.
std::vector<StageInfo> stage_infos(const StageRegistry& registry);

}  // namespace tassilo
