#include "tassilo/overlay/internal/bird_view.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tassilo/overlay/internal/text.h"

namespace tassilo {
namespace {

constexpr double kBehind = .55;     // of the floor behind the robot that shows [m]
constexpr double kHalfWidth = 2.4;  // of the floor to each side, at least [m]

/// One drawing of the view: robot frame in, canvas out.
class BirdDrawing {
 public:
  BirdDrawing(Canvas& canvas, const Rect& place, double range)
      : canvas_(canvas),
        place_(place),
        px_per_m_(std::min(place.height / (range + kBehind), place.width / (2 * kHalfWidth))),
        unit_(std::clamp(px_per_m_ / 55, .8, 1.6)) {}

  void draw(const Scene& scene) const {
    if (scene.free_space) unseen(*scene.free_space);
    rings();
    if (scene.free_space) free_space(*scene.free_space);
    for (const LineSeen& line : scene.lines) this->line(line);
    for (const CircleSeen& circle : scene.circles)
      canvas_.stroke_circle(at(circle.center), circle.radius * px_per_m_,
                            {.ink = kLineInk.with_alpha(.9), .width = 1.6 * unit_});
    for (const Goal& goal : scene.goals) this->goal(goal);
    for (const RobotSeen& robot : scene.robots)
      if (robot.floor) this->robot(robot.team, *robot.floor);
    for (std::size_t i = scene.balls.size(); i-- > 0;)
      if (scene.balls[i].floor) ball(*scene.balls[i].floor, i == 0);
    for (const TrackSeen& track : scene.tracks) this->track(track);
    self();
    ring_labels();
  }

 private:
  CanvasPoint at(FloorPoint p) const {
    return {place_.x + place_.width / 2 - p.y * px_per_m_, place_.bottom() - (kBehind + p.x) * px_per_m_};
  }
  static FloorPoint polar(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle)}; }
  double farthest() const { return std::hypot(place_.height, place_.width) / px_per_m_; }

  void rings() const {
    for (int m = 1; m <= farthest(); ++m)
      canvas_.stroke_circle(at({}), m * px_per_m_, {.ink = kGridInk.with_alpha(.55), .width = 1});
    const double far = farthest();
    for (const int degrees : {-90, -45, 0, 45, 90}) {
      const double angle = degrees * std::numbers::pi / 180;
      canvas_.polyline(std::vector{at({}), at(polar(far, angle))}, {.ink = kGridInk.with_alpha(.35), .width = 1});
    }
  }

  void ring_labels() const {
    const TextStyle style{.size = 9.5 * unit_, .ink = kQuietTextInk};
    for (int m = 1; m * px_per_m_ < place_.height - kBehind * px_per_m_ - style.size; ++m) {
      const CanvasPoint top = at({static_cast<double>(m), 0});
      canvas_.text(std::to_string(m) + " m", {top.x + 3 * unit_, top.y}, TextAnchor::left, style);
    }
  }

  std::vector<CanvasPoint> arc(const FreeSpace& space, std::size_t sector, double radius) const {
    constexpr int kSteps = 6;
    std::vector<CanvasPoint> points;
    for (int i = 0; i <= kSteps; ++i) {
      const double angle = space.angle_min +
                           (static_cast<double>(sector) - .5 + static_cast<double>(i) / kSteps) * space.angle_increment;
      points.push_back(at(space.origin + polar(radius, angle)));
    }
    return points;
  }

  void unseen(const FreeSpace& space) const {
    std::vector<std::vector<CanvasPoint>> wedges;
    for (std::size_t k = 0; k < space.states.size(); ++k) {
      if (space.states[k] != SectorState::unseen) continue;
      wedges.push_back(arc(space, k, farthest() + 1));
      wedges.back().push_back(at(space.origin));
    }
    canvas_.fill_polygons(wedges, kUnseenInk.with_alpha(.16));
  }

  void free_space(const FreeSpace& space) const {
    std::vector<std::vector<CanvasPoint>> wedges;
    for (std::size_t k = 0; k < space.states.size(); ++k) {
      if (space.states[k] == SectorState::unseen) continue;
      wedges.push_back(arc(space, k, space.ranges[k]));
      wedges.back().push_back(at(space.origin));
    }
    canvas_.fill_polygons(wedges, kFreeInk.with_alpha(.20));
    for (std::size_t k = 0; k < space.states.size(); ++k) {
      if (space.states[k] == SectorState::unseen) continue;
      const bool is_blocked = space.states[k] == SectorState::blocked;
      canvas_.polyline(arc(space, k, space.ranges[k]), {.ink = is_blocked ? kBlockedInk : kFreeInk.with_alpha(.6),
                                                        .width = (is_blocked ? 2.2 : 1.0) * unit_});
    }
  }

  void line(const LineSeen& line) const {
    if (!line.floor) return;
    canvas_.polyline(std::vector{at(line.floor->first), at(line.floor->second)},
                     {.ink = line_ink(line.kind), .width = 2 * unit_});
  }

  void goal(const Goal& goal) const {
    const Ink color = goal_ink(goal.color);
    for (const GoalPost& post : goal.posts) canvas_.fill_circle(at(post.position), 3 * unit_, color);
    if (goal.posts.size() == 2) {
      canvas_.polyline(std::vector{at(goal.posts[0].position), at(goal.posts[1].position)},
                       {.ink = color, .width = 4 * unit_});
    } else if (goal.position) {
      // A bar across the line of sight: which way the mouth faces is not known.
      const double across = bearing(*goal.position) + std::numbers::pi / 2;
      canvas_.polyline(std::vector{at(*goal.position + polar(.4, across)), at(*goal.position + polar(-.4, across))},
                       {.ink = color, .width = 4 * unit_});
    } else if (goal.bearing) {
      canvas_.polyline(std::vector{at(polar(.45, *goal.bearing)), at(polar(farthest(), *goal.bearing))},
                       {.ink = color.with_alpha(.8), .width = 1.6 * unit_, .dashed = true});
    }
  }

  void ellipse(const Gaussian2<RobotFrame>& position, Ink color) const {
    constexpr double kSigmas = 2;
    constexpr int kSteps = 40;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(position.covariance);
    const Eigen::Vector2d radii = kSigmas * solver.eigenvalues().cwiseMax(0).cwiseSqrt();
    std::vector<CanvasPoint> points;
    for (int i = 0; i <= kSteps; ++i) {
      const double angle = 2 * std::numbers::pi * i / kSteps;
      const Eigen::Vector2d p =
          solver.eigenvectors() * Eigen::Vector2d(radii.x() * std::cos(angle), radii.y() * std::sin(angle));
      points.push_back(at(position.mean + FloorPoint{p.x(), p.y()}));
    }
    canvas_.fill_polygons({&points, 1}, color.with_alpha(.25 * color.a));
    canvas_.polyline(points, {.ink = color, .width = 1.3 * unit_});
  }

  /// From near to far along the line of sight, with a crossbar at each end.
  void bracket(FloorPoint position, DistanceBounds bounds, Ink color) const {
    const double angle = bearing(position);
    const Pen pen{.ink = color, .width = 1.3 * unit_};
    const double half = 4 * unit_ / px_per_m_;
    const FloorPoint across = polar(half, angle + std::numbers::pi / 2);
    const FloorPoint near = polar(bounds.near, angle), far = polar(bounds.far, angle);
    canvas_.polyline(std::vector{at(near), at(far)}, pen);
    for (const FloorPoint end : {near, far}) canvas_.polyline(std::vector{at(end - across), at(end + across)}, pen);
  }

  void ball(const BallOnFloor& ball, bool is_best) const {
    const Ink color = kBallInk.with_alpha(is_best ? 1 : .5);
    ellipse(ball.position, color);
    bracket(ball.position.mean, ball.bounds, color);
    canvas_.fill_circle(at(ball.position.mean), (is_best ? 3.6 : 2.6) * unit_, color);
    if (!is_best) return;
    const CanvasPoint place = at(ball.position.mean);
    canvas_.text(meters(norm(ball.position.mean)), {place.x + 11 * unit_, place.y}, TextAnchor::left,
                 {.size = 11 * unit_, .ink = kBallInk, .weight = TextWeight::bold});
  }

  void robot(Team team, const RobotOnFloor& robot) const {
    const Ink color = team_ink(team);
    const double radius = std::max(robot.width / 2, .1) * px_per_m_;
    canvas_.fill_circle(at(robot.center), radius, color.with_alpha(.22));
    canvas_.stroke_circle(at(robot.center), radius, {.ink = color, .width = 1.6 * unit_});
    bracket(robot.nearest.mean, robot.bounds, color.with_alpha(.7));
    canvas_.fill_circle(at(robot.nearest.mean), 2.6 * unit_, color);
  }

  /// Where it comes in a moment, and its number; a dashed ring where it is remembered only.
  void track(const TrackSeen& track) const {
    const FloorPoint place{track.x, track.y};
    const CanvasPoint middle = at(place);
    const Ink color = track_ink(track);
    const double radius = track.kind == TrackKind::ball ? 5 * unit_ : .2 * px_per_m_;
    if (track.age > 0) canvas_.stroke_circle(middle, radius, {.ink = color, .width = 1.3 * unit_, .dashed = true});
    canvas_.arrow(middle, at(place + kArrowTime * FloorPoint{track.vx, track.vy}),
                  {.ink = color, .width = 1.6 * unit_});
    canvas_.text(number_text(track.id), {middle.x - radius - 3 * unit_, middle.y}, TextAnchor::right,
                 {.size = 9.5 * unit_, .ink = color});
  }

  void self() const {
    constexpr double kNose = .26, kTail = -.14, kSide = .17;  // [m]
    const std::vector<CanvasPoint> arrow{at({kNose, 0}), at({kTail, kSide}), at({kTail * .4, 0}), at({kTail, -kSide})};
    canvas_.fill_polygons({&arrow, 1}, kTextInk);
  }

  Canvas& canvas_;
  Rect place_;
  double px_per_m_;
  double unit_;  ///< Size of strokes and text relative to the usual panel. [1]
};

}  // namespace

void draw_bird_view(Canvas& canvas, const Rect& place, const Scene& scene, double range) {
  canvas.clipped(place, [&] {
    canvas.fill_rect(place, kPanelInk.with_alpha(.92));
    BirdDrawing(canvas, place, range).draw(scene);
    canvas.fill_rect({place.x, place.y, 1, place.height}, kGridInk);
  });
}

}  // namespace tassilo
