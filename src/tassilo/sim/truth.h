#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tassilo/camera/mount.h"
#include "tassilo/field/field_model.h"
#include "tassilo/sim/renderer.h"
#include "tassilo/sim/script.h"
#include "tassilo/sim/world_state.h"

namespace tassilo {

/// Free floor around a robot, in sectors of 10 degrees; sector k is centred on k * 10 degrees in the robot frame.
struct TrueFreeSpace {
  static constexpr int kSectors = 36;
  FloorPoint origin;
  std::array<std::optional<double>, kSectors> ray, least;  ///< Along the centre, and over the sector. [m]
  std::array<std::string, kSectors> hit;  ///< wall, goal_yellow, goal_blue, robotN, none; of the centre.
};

/// Walls, goal panels and robots are obstacles; ball and lines are not. Robots are numbered without the observer.
TrueFreeSpace true_free_space(const FieldModel& field, const SimState& state, int observer, FloorPoint origin);

/// What is true of one frame besides the state.
struct TruthOfFrame {
  std::int64_t frame = 0;
  RobotMotion motion, odometry;  ///< Since the frame before, as it was and as the wheels have it.
  std::string light = "normal";  ///< Mode.
  std::vector<SimLamp> lamps;
  double ambient = 0;
};

/// The truth of frames in the form of the recordings' gt.jsonl: a JSON object without a line break.
///
/// Fields without one of the two goals have it as never seen.
class TruthLines {
 public:
  TruthLines(const FieldModel& field, const MountedCamera& camera) : field_(field), camera_(camera) {}
  /// `view` is what the renderer saw of the state; `observer` a robot of it.
  std::string line(const SimState& state, int observer, const SimView& view, const TruthOfFrame& frame) const;

 private:
  FieldModel field_;
  MountedCamera camera_;
};

}  // namespace tassilo
