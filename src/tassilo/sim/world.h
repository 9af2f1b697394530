#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "tassilo/behavior/wheel_command.h"
#include "tassilo/field/field_model.h"
#include "tassilo/geometry/point.h"
#include "tassilo/scene/scene.h"
#include "tassilo/sim/world_state.h"
#include "tassilo/timeline/odometry.h"

// The simulated world: what is true, and how it changes. Nobody who plays in it may look at it: players get pictures
// and odometry.

namespace tassilo {

/// Constants of the simulated world. Those of robots are of a robot of the walled middle-size league.
struct WorldOptions {
  std::uint64_t seed = 1;                      ///< Of slip and kicks.
  GoalSide cyan_own_goal = GoalSide::minus_x;  ///< The goal that cyan defends; magenta has the other one.
  double ball_friction = 0.4;                  ///< Of a ball that rolls on carpet. [m/s^2], > 0
  double wall_restitution = 0.5;               ///< Share of its speed that a ball keeps at walls and posts. 0..1
  double robot_restitution = 0.3;              ///< And at robots, relative to them. 0..1
  double wheel_base = 0.8;                     ///< Between the wheels, of the robot's diameter. [1], > 0, <= 1
  double max_wheel_speed = 1.2;                ///< Motors of that size. [m/s], > 0
  double max_wheel_acceleration = 2;           ///< Of a wheel; more than that spins on carpet. [m/s^2], > 0
  double slip_sigma = 0.03;                    ///< Of a wheel's way, within some tenths of a second. [1], >= 0
  double wheel_sigma = 0.005;                  ///< Of a wheel's circumference, for good. [1], >= 0
  double slip_correlation_s = 0.3;             ///< How long a wheel slips alike. [s], > 0
  double guide_deg = 25;                  ///< The ball is guided where it is no further from ahead. [deg], > 0, < 90
  double guide_time_s = 0.1;              ///< In which the guide stops it from rolling along the front. [s], > 0
  double guide_acceleration = 3;          ///< And no harder than that: it is lost in sharp turns. [m/s^2], >= 0
  double kick_speed = 3;                  ///< Added to the robot's own; a pneumatic kicker. [m/s], >= 0
  double kick_reach = 0.03;               ///< Gap over which a kick still reaches the ball. [m], >= 0
  double kick_sigma_deg = 3;              ///< Of its direction. [deg], >= 0
  double kick_pause_s = 1;                ///< Until the kicker has pressure again. [s], >= 0
  double run_off = 0.5;                   ///< Robots get no further out of a field without walls. [m], > 0
  double stuck_s = 8;                     ///< A ball that stays where it is for so long is stuck. [s], > 0
  double stuck_distance = 0.05;           ///< It stays while it gets no further, of the field's length. [1], > 0
  bool places_robots_at_kick_off = true;  ///< After a goal; else robots stay where they are.
  void check() const;                     ///< Throws Error naming the first field out of range.
};

enum class RefereeCall { kick_off, goal, ball_out, stuck_ball };
std::string_view to_string(RefereeCall call);

/// What the referee calls; it is carried out at once.
struct RefereeEvent {
  double t = 0;  ///< [s]
  RefereeCall call = RefereeCall::kick_off;
  Team team = Team::unknown;  ///< Who scored, or has the kick-off.
  friend bool operator==(const RefereeEvent&, const RefereeEvent&) = default;
};

struct Score {
  int cyan = 0, magenta = 0;
  friend bool operator==(const Score&, const Score&) = default;
};

/// A command for one robot.
struct RobotCommand {
  int robot = 0;  ///< Its id.
  WheelCommand wheels;
};

/// Where a robot stands at kick-off.
struct KickOffPlace {
  FieldPoint at;
  double theta = 0;  ///< Towards the other goal. [rad]
};

/// Where the robots of a team stand at kick-off, the goalkeeper first: all in their own half, none in the centre circle
/// but the first one after the goalkeeper, who stands at the ball when the team has the kick-off.
///
/// Throws Error when so many find no room on the field.
std::vector<KickOffPlace> kick_off_places(const FieldModel& field, GoalSide own_goal, int robots, bool has_kick_off);

/// Something straight that neither ball nor robots get through: a wall's foot, the side or back of a goal.
struct Barrier {
  FieldPoint p, q;
};

/// Two teams, a ball, walls, goals and a referee of the simplest kind.
///
/// Robots are upright cylinders with two driven wheels, the ball rolls on the floor. Time goes in ticks of kTick,
/// within which the ball moves by no more than a quarter of its radius at once, so that nothing is tunnelled through
/// however fast it is. What happens depends on the seed, on the commands and on when they come, not on how time is cut.
///
/// A goal counts when the ball's middle passes the goal line between the posts; fields without goals have none to
/// score. Where there are no walls the ball is out when all of it is behind a line. A ball that is out or stuck goes to
/// the nearest free neutral spot.
///
/// threads  one at a time
class World {
 public:
  static constexpr double kTick = 0.001;  ///< [s]

  /// The ball lies in the middle; cyan has the first kick-off. Throws Error for a field or options out of range.
  explicit World(const FieldModel& field, const WorldOptions& options = {});

  /// A robot comes to its team, of the size that the field file says; before the first tick its team lines up anew,
  /// later it comes to a free place in its own half. Throws Error when the id is in use or out of 0..255, when the team
  /// is unknown, and when there is no room.
  void add(int id, Team team);
  /// Takes it off the field. Throws Error when there is none of this id.
  void remove(int id);
  /// Puts a robot, or the ball, somewhere; odometry knows nothing of it. Throws Error when there is no room.
  void place(int id, FieldPoint at, double theta);
  void place_ball(FieldPoint at, double vx, double vy);

  /// Lets time go on. A robot without a command brakes. Commands for robots that are not there are passed over.
  ///
  /// dt       >= 0; time is rounded to ticks in the sum, not in each step [s]
  /// returns  what the referee called, in order of time
  std::vector<RefereeEvent> step(double dt, std::span<const RobotCommand> commands);

  const SimState& state() const { return state_; }
  const FieldModel& field() const { return field_; }
  const WorldOptions& options() const { return options_; }
  const std::vector<Barrier>& barriers() const { return barriers_; }
  Score score() const { return score_; }
  GoalSide own_goal(Team team) const;
  /// What the wheels of a robot told until now: from (0, 0, 0) when it came. Throws Error when there is none of this
  /// id.
  OdometrySample odometry(int id) const;
  double wheel_base(int id) const;  ///< Between the wheels of a robot; throws as odometry does. [m]

 private:
  /// What a robot is besides what is seen of it; in the order of state_.robots.
  struct Drive {
    std::mt19937_64 random;
    double left = 0, right = 0;              ///< Of the wheels. [m/s]
    double left_scale = 1, right_scale = 1;  ///< Way over the floor by what the wheel tells, for good.
    double left_slip = 0, right_slip = 0;    ///< And for the moment. [1]
    double odometry_x = 0, odometry_y = 0, odometry_theta = 0;
    double vx = 0, vy = 0;    ///< As it really moves. [m/s]
    double kicked_at = -1e9;  ///< [s]
    WheelCommand command;
  };

  std::size_t index_of(int id) const;
  void line_up();
  void kick_off(Team team, std::vector<RefereeEvent>& events);
  void put_ball_to_free_spot(FieldPoint near);
  FieldPoint free_spot(FieldPoint near, double radius, double away_from) const;
  double clearance(FieldPoint at) const;

  void tick(std::vector<RefereeEvent>& events);
  void drive(std::size_t i);
  void push_robots_apart();
  bool are_robots_apart() const;
  void kick(std::size_t i);
  void roll_ball(std::vector<RefereeEvent>& events);
  void bounce_ball();
  void bounce_off_robot(std::size_t i, double dt);
  bool is_ball_clear() const;
  bool is_goal(FieldPoint before, std::vector<RefereeEvent>& events);
  void referee(std::vector<RefereeEvent>& events);

  FieldModel field_;
  WorldOptions options_;
  std::vector<Barrier> barriers_;
  SimState state_;
  std::vector<Drive> drives_;
  Score score_;
  Team kick_off_team_ = Team::cyan;
  double asked_ = 0;        ///< Time that was asked for. [s]
  std::int64_t ticks_ = 0;  ///< That went by.
  FieldPoint ball_stays_at_;
  double ball_stays_since_ = 0;  ///< [s]
};

}  // namespace tassilo
