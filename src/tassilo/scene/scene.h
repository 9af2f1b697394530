#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "tassilo/base/recycled.h"
#include "tassilo/base/recycled_string.h"
#include "tassilo/field/field_model.h"
#include "tassilo/geometry/box.h"
#include "tassilo/geometry/point.h"

// Everything seen in one frame, as plain values that travel. Floor values are in the robot frame and missing without a
// calibrated, mounted camera; distances and bearings are from the robot's origin. docs/conventions.md,
// schema/scene.schema.json.

namespace tassilo {

/// Bounds on a distance. [m]
struct DistanceBounds {
  double near = 0, far = 0;
};

/// Floor values of a ball: the floor point below its centre.
struct BallOnFloor {
  Gaussian2<RobotFrame> position;
  DistanceBounds bounds;
};
struct Ball {
  PixelBox box;           ///< Visible part.
  PixelPoint center;      ///< Projected centre of the sphere; without a camera: of the disc. [px]
  double radius_px = 0;   ///< Mean radius of the whole disc. [px]
  double confidence = 0;  ///< 0..1
  std::optional<BallOnFloor> floor;
};

enum class PostSide { left, right };  ///< As the robot sees it.
struct GoalPost {
  PostSide side = PostSide::left;
  FloorPoint position;
};
struct Goal {
  GoalColor color = GoalColor::yellow;
  PixelBox box;
  std::optional<double> bearing;       ///< Of the mouth's middle, or of the visible part when that is unknown. [rad]
  std::optional<FloorPoint> position;  ///< Middle of the mouth.
  RecycledVector<GoalPost> posts;
};

enum class Team { unknown, cyan, magenta };
/// Floor values of a robot: the visible outline point on the floor nearest to us.
struct RobotOnFloor {
  Gaussian2<RobotFrame> nearest;
  DistanceBounds bounds;
  FloorPoint center;  ///< Estimated middle of the robot.
  double width = 0;   ///< Across the line of sight. [m]
};
struct RobotSeen {
  Team team = Team::unknown;
  PixelBox box;  ///< Whole visible robot.
  std::optional<RobotOnFloor> floor;
};

enum class LineKind { line, boundary };
struct LineSeen {
  LineKind kind = LineKind::line;
  PixelPoint image_p, image_q;
  std::optional<std::pair<FloorPoint, FloorPoint>> floor;
  std::string model;  ///< x_plus, x_minus, y_plus, y_minus, halfway, ...; empty: not matched.
};
struct CircleSeen {
  FloorPoint center;
  double radius = 0;  ///< [m]
};

enum class SectorState { unseen, free, blocked };
struct FreeSpace {
  FloorPoint origin;
  double angle_min = 0;           ///< Centre of sector 0, robot frame. [rad]
  double angle_increment = 0;     ///< [rad]
  RecycledVector<double> ranges;  ///< From origin; meaningless where unseen. [m]
  RecycledVector<SectorState> states;
};

enum class PoseKind { two_lines, one_line, predicted, goal, model, start };
struct PoseSeen {
  double x = 0, y = 0, theta = 0;      ///< Field frame.
  std::array<double, 9> covariance{};  ///< Row-major x, y, theta.
  PoseKind kind = PoseKind::start;
  double age = 0;       ///< Since the last absolute fix. [s]
  bool mirror = false;  ///< The point-mirrored pose is as likely.
};

enum class TrackKind { ball, robot };
/// An object followed over time, as it is at the frame's time, seen or not.
///
/// The velocity is over the floor, that of the object relative to the field, expressed in the robot's axes: a ball that
/// lies still has none however the robot drives and turns.
struct TrackSeen {
  int id = 0;  ///< The same for one object as long as it is followed; > 0 and never given twice.
  TrackKind kind = TrackKind::ball;
  Team team = Team::unknown;            ///< Of a robot, by most of its sightings.
  double x = 0, y = 0;                  ///< Of the ball's floor point, of the robot's middle; robot frame. [m]
  double vx = 0, vy = 0;                ///< [m/s]
  std::array<double, 16> covariance{};  ///< Row-major x, y, vx, vy.
  double age = 0;                       ///< Since it was last seen; 0: in this frame. [s]
};

/// Duration of each stage. [ms]
struct StageTime {
  std::string stage;
  double ms = 0;
};

struct Scene {
  std::int64_t frame = 0;
  double t = 0;       ///< Capture time on the source's clock. [s]
  std::string image;  ///< File name for single images, else empty.
  std::optional<PoseSeen> pose;
  RecycledVector<Ball> balls;  ///< Best first.
  RecycledVector<Goal> goals;
  RecycledVector<RobotSeen> robots;
  RecycledVector<LineSeen> lines;
  RecycledVector<CircleSeen> circles;
  std::optional<FreeSpace> free_space;
  RecycledVector<TrackSeen> tracks;  ///< Balls first, most often seen first; then robots by id.
  RecycledVector<std::pair<std::string, RecycledString>> why;  ///< Subject -> short reason of acceptance or refusal.
  RecycledVector<StageTime> timing;                            ///< In the order they ran; "total" last.
};

std::string_view to_string(GoalColor color);
std::string_view to_string(Team team);
std::string_view to_string(PostSide side);
std::string_view to_string(LineKind kind);
std::string_view to_string(SectorState state);
std::string_view to_string(PoseKind kind);
std::string_view to_string(TrackKind kind);

}  // namespace tassilo
