#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "tassilo/field/field_model.h"
#include "tassilo/sim/renderer.h"
#include "tassilo/sim/world_state.h"

namespace tassilo {

/// What moves how, as whoever renders a recording asks for it: times never go back. Physics takes the same place.
using SimMotion = std::function<SimState(double t)>;

/// A drive for recordings, without a game: robots go to places of the field one after the other, smoothly and around
/// each other; the first one, which looks, most often towards the ball; the ball rolls and is nudged now and then.
struct ScriptOptions {
  int others = 4;          ///< Robots besides the one that looks. 0..20
  double ball_radius = 0;  ///< 0: the middle of the field's interval. [m], >= 0
  double speed = 0.9;      ///< Largest of the robot that looks; of others half of it. [m/s], > 0
  double turn = 1.2;       ///< Largest. [rad/s], > 0
  Team team = Team::cyan;  ///< Of the robot that looks.
  int id = 1;              ///< Of the robot that looks; others have further numbers. 0..255
  std::uint64_t seed = 1;
  void check() const;  ///< Throws Error naming the first value out of range.
};

/// Deterministic by its options; the state at 0 is where all start.
SimMotion scripted_motion(const FieldModel& field, const ScriptOptions& options);

/// No motion but pictures for training: every second, everybody stands somewhere else, and the one that looks has in
/// turn the ball, each goal and a robot before it.
SimMotion scripted_stills(const FieldModel& field, const ScriptOptions& options);

/// From frame to frame, in the robot frame of the frame before.
struct RobotMotion {
  double dx = 0, dy = 0, dtheta = 0;  ///< [m, m, rad]
};
RobotMotion motion_between(const SimRobot& before, const SimRobot& after);

/// Odometry of wheels that slip: a scale error as long as the recording lasts, and noise that grows with the way.
class SlippingWheels {
 public:
  explicit SlippingWheels(std::uint64_t seed);
  /// What the wheels say when this is how the robot moved.
  RobotMotion measured(const RobotMotion& motion);

 private:
  double normal();

  std::uint64_t state_;
  double scale_, turn_scale_;
};

/// How hard a recording is to see.
enum class Difficulty {
  easy,    ///< Even light, little noise, hardly anything around the field.
  normal,  ///< As most of the recordings.
  hard,    ///< Noise, motion blur, light from one side, many people, some dressed like the ball.
};
/// Light, lens, sensor and surroundings of a difficulty on a field.
RenderOptions rendering_of(Difficulty difficulty, const FieldModel& field);

}  // namespace tassilo
