#include "tassilo/sim/truth.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <string_view>

#include "tassilo/base/contract.h"
#include "tassilo/field/field_curves.h"
#include "tassilo/geometry/angle.h"
#include "tassilo/geometry/pose2.h"

namespace tassilo {
namespace {

constexpr int kVisiblePixels = 8;  ///< So many make an object visible.

/// JSON of numbers and lists, keys in the order they come.
class Text {
 public:
  Text& key(std::string_view name) {
    comma();
    text_ += '"';
    text_ += name;
    text_ += "\":";
    fresh_ = true;
    return *this;
  }
  Text& open(char bracket) {
    comma();
    text_ += bracket;
    fresh_ = true;
    return *this;
  }
  Text& close(char bracket) {
    text_ += bracket;
    fresh_ = false;
    return *this;
  }
  Text& raw(std::string_view value) {
    comma();
    text_ += value;
    return *this;
  }
  Text& text(std::string_view value) {  // names of ours: nothing to escape
    comma();
    text_ += '"';
    text_ += value;
    text_ += '"';
    return *this;
  }
  Text& number(double value, int digits = 6) {
    std::array<char, 64> digits_of;
    const auto [end, problem] =
        std::to_chars(digits_of.data(), digits_of.data() + digits_of.size(), value, std::chars_format::fixed, digits);
    expects(problem == std::errc{}, "TruthLines: numbers are finite and of this world");
    std::string_view shown(digits_of.data(), static_cast<std::size_t>(end - digits_of.data()));
    if (digits > 0) {
      while (shown.ends_with('0')) shown.remove_suffix(1);
      if (shown.ends_with('.')) shown.remove_suffix(1);
    }
    return raw(shown == "-0" ? "0" : shown);
  }
  Text& truth(bool value) { return raw(value ? "true" : "false"); }
  Text& null() { return raw("null"); }
  Text& numbers(std::initializer_list<double> values, int digits = 5) {
    open('[');
    for (const double value : values) number(value, digits);
    return close(']');
  }
  Text& maybe(const std::optional<double>& value, int digits = 4) { return value ? number(*value, digits) : null(); }
  Text& maybe(const std::optional<PixelPoint>& p) { return p ? numbers({p->x, p->y}, 3) : null(); }

  std::string take() { return std::move(text_); }

 private:
  void comma() {
    if (!fresh_) text_ += ',';
    fresh_ = false;
  }

  std::string text_;
  bool fresh_ = true;
};

struct Segment {
  FieldPoint p, q;
  std::string_view what;
};

std::string_view name_of(const FieldModel::Goal& goal) {
  return goal.color == GoalColor::blue ? "goal_blue" : "goal_yellow";
}

double mouth_x(const FieldModel& field, const FieldModel::Goal& goal) {
  const FieldExtent extent = field_extent(field);
  return goal.side == GoalSide::plus_x ? extent.x.high : extent.x.low;
}

std::vector<Segment> obstacles_of(const FieldModel& field) {
  std::vector<Segment> segments;
  for (const FieldLine& line : field_curves(field).lines)
    if (line.is_wall) segments.push_back({line.p, line.q, "wall"});
  for (const FieldModel::Goal& goal : field.goals) {
    const double x = mouth_x(field, goal), back = x + (goal.side == GoalSide::plus_x ? goal.depth : -goal.depth),
                 y = goal.width / 2;
    segments.push_back({{x, y}, {back, y}, name_of(goal)});
    segments.push_back({{back, y}, {back, -y}, name_of(goal)});
    segments.push_back({{back, -y}, {x, -y}, name_of(goal)});
  }
  return segments;
}

struct Hit {
  double range = std::numeric_limits<double>::infinity();
  std::string_view what;
  int robot = -1;  ///< Index of the state.
};

Hit nearest_along(const std::vector<Segment>& segments, const SimState& state, int observer, FieldPoint from,
                  double angle) {
  Hit hit;
  const FieldPoint along{std::cos(angle), std::sin(angle)};
  for (const Segment& segment : segments) {
    const FieldPoint edge = segment.q - segment.p, to = segment.p - from;
    const double across = cross(along, edge);
    if (std::abs(across) < 1e-12) continue;
    const double range = cross(to, edge) / across, share = cross(to, along) / across;
    if (range > 0 && share >= -1e-9 && share <= 1 + 1e-9 && range < hit.range) hit = {range, segment.what, -1};
  }
  for (std::size_t k = 0; k < state.robots.size(); ++k) {
    const SimRobot& robot = state.robots[k];
    if (robot.id == observer) continue;
    const FieldPoint to = robot.at - from;
    const double middle = dot(to, along), off = dot(to, to) - middle * middle;
    if (middle <= 0 || off >= robot.radius * robot.radius) continue;
    const double range = std::max(0., middle - std::sqrt(robot.radius * robot.radius - off));
    if (range < hit.range) hit = {range, "robot", static_cast<int>(k)};
  }
  return hit;
}

const SimRobot& robot_of(const SimState& state, int id) {
  const SimRobot* const found = find_robot(state, id);
  expects(found != nullptr, "truth: the observer is a robot of the state");
  return *found;
}

/// Its number among the others.
int number_of(const SimState& state, int observer, int index) {
  int number = 0;
  for (int k = 0; k < index; ++k) number += state.robots[static_cast<std::size_t>(k)].id != observer;
  return number;
}

bool in_image(const CameraModel& camera, PixelPoint p) {
  return p.x >= -.5 && p.y >= -.5 && p.x <= camera.width - .5 && p.y <= camera.height - .5;
}

/// A sphere or an upright cylinder before the stretch from the eye to a place.
bool hides(const SimBall& ball, const Point3<FieldFrame>& eye, const Point3<FieldFrame>& place) {
  const Point3<FieldFrame> way = place - eye, to = Point3<FieldFrame>{ball.at.x, ball.at.y, ball.radius} - eye;
  const double share = std::clamp(dot(to, way) / dot(way, way), 0., 1.);
  return norm(to - share * way) < ball.radius;
}
bool hides(const SimRobot& robot, const Point3<FieldFrame>& eye, const Point3<FieldFrame>& place) {
  const FieldPoint way{place.x - eye.x, place.y - eye.y}, to = robot.at - FieldPoint{eye.x, eye.y};
  const double square = dot(way, way), middle = dot(to, way) / square, off = dot(to, to) - middle * middle * square;
  const double inside = robot.radius * robot.radius - off;
  if (inside <= 0) return false;
  const double half = std::sqrt(inside / square);
  // Within the cylinder's height somewhere between where the way enters and leaves it.
  const double enter = std::max(0., middle - half), leave = std::min(1., middle + half);
  return enter < leave && eye.z + leave * (place.z - eye.z) < robot.height;
}

void add_visibility(Text& out, const SimVisibility& view) {
  const auto box = [&](const std::optional<std::array<int, 4>>& b) {
    if (!b) {
      out.null();
      return;
    }
    out.open('[');
    for (const int v : *b) out.number(v, 0);
    out.close(']');
  };
  out.key("visible").truth(view.visible_px >= kVisiblePixels);
  out.key("visible_px").number(view.visible_px, 0);
  out.key("silhouette_px").number(view.silhouette_px, 0);
  out.key("visible_fraction");
  out.number(view.silhouette_px > 0 ? std::min(1., static_cast<double>(view.visible_px) / view.silhouette_px) : 0, 4);
  out.key("bbox");
  box(view.box);
  out.key("bbox_full");
  box(view.full_box);
  out.key("truncated").truth(view.truncated);
}

void add_motion(Text& out, std::string_view key, const RobotMotion& motion) {
  out.key(key)
      .open('{')
      .key("dx")
      .number(motion.dx)
      .key("dy")
      .number(motion.dy)
      .key("dtheta")
      .number(motion.dtheta)
      .close('}');
}

void add_free(Text& out, const TrueFreeSpace& free) {
  out.key("origin").numbers({free.origin.x, free.origin.y});
  out.key("ray").open('[');
  for (const auto& range : free.ray) out.maybe(range);
  out.close(']').key("min").open('[');
  for (const auto& range : free.least) out.maybe(range);
  out.close(']').key("hit").open('[');
  for (const std::string& what : free.hit) out.text(what);
  out.close(']');
}

}  // namespace

TrueFreeSpace true_free_space(const FieldModel& field, const SimState& state, int observer, FloorPoint origin) {
  constexpr int steps = 50;  // to each side of a sector's centre: a tenth of a degree
  const SimRobot& me = robot_of(state, observer);
  const FieldPoint from = pose_of(me) * origin;
  const std::vector<Segment> segments = obstacles_of(field);
  TrueFreeSpace free{.origin = origin, .ray = {}, .least = {}, .hit = {}};
  for (int k = 0; k < TrueFreeSpace::kSectors; ++k) {
    const auto sector = static_cast<std::size_t>(k);
    const double center = me.theta + radians(10. * k);
    const Hit hit = nearest_along(segments, state, observer, from, center);
    free.hit[sector] = "none";
    if (std::isfinite(hit.range)) {
      free.ray[sector] = hit.range;
      free.hit[sector] = hit.what;
      if (hit.robot >= 0) free.hit[sector] += std::to_string(number_of(state, observer, hit.robot));
    }
    double least = hit.range;
    for (int i = -steps; i <= steps; ++i)
      least = std::min(least, nearest_along(segments, state, observer, from, center + radians(5. * i / steps)).range);
    if (std::isfinite(least)) free.least[sector] = least;
  }
  return free;
}

std::string TruthLines::line(const SimState& state, int observer, const SimView& view,
                             const TruthOfFrame& frame) const {
  const SimRobot& me = robot_of(state, observer);
  const FieldFromRobot field_from_robot = pose_of(me);
  const auto robot_from_field = inverse(field_from_robot);
  const auto pixel = [&](FloorPoint at, double z) -> std::optional<PixelPoint> {
    return camera_.project({at.x, at.y, z});
  };
  const auto pixel_in_image = [&](FloorPoint at) {
    auto p = pixel(at, 0);
    if (p && !in_image(camera_.model(), *p)) p.reset();
    return p;
  };
  Text out;
  out.open('{').key("frame").number(static_cast<double>(frame.frame), 0).key("t").number(state.t);
  out.key("robot")
      .open('{')
      .key("x")
      .number(me.at.x)
      .key("y")
      .number(me.at.y)
      .key("theta")
      .number(wrap_angle(me.theta))
      .close('}');
  out.key("vel").open('{').key("vx").number(me.speed).key("vy").number(0).key("omega").number(me.turn).close('}');
  add_motion(out, "odom_true", frame.motion);
  add_motion(out, "odom", frame.odometry);

  const SimBall& ball = state.ball;
  const FloorPoint ball_at = robot_from_field * ball.at;
  out.key("ball").open('{').key("x").number(ball.at.x).key("y").number(ball.at.y).key("z").number(ball.radius);
  out.key("radius").number(ball.radius).key("vx").number(ball.vx).key("vy").number(ball.vy);
  out.key("rx")
      .number(ball_at.x)
      .key("ry")
      .number(ball_at.y)
      .key("dist")
      .number(norm(ball_at))
      .key("bearing")
      .number(bearing(ball_at));
  out.key("center_px").maybe(pixel(ball_at, ball.radius));
  add_visibility(out, view.ball);
  out.close('}');

  out.key("robots").open('[');
  int number = 0;
  for (std::size_t k = 0; k < state.robots.size(); ++k) {
    const SimRobot& robot = state.robots[k];
    if (robot.id == observer) continue;
    const FloorPoint at = robot_from_field * robot.at;
    const RobotLook look = robot_look(robot, field_);
    out.open('{').key("id").number(number, 0).key("object_id").number(robot.id, 0);
    out.key("x").number(robot.at.x).key("y").number(robot.at.y).key("theta").number(wrap_angle(robot.theta));
    out.key("rx").number(at.x).key("ry").number(at.y).key("rtheta").number(wrap_angle(robot.theta - me.theta));
    out.key("shape").text("cylinder").key("size").numbers({2 * robot.radius, 2 * robot.radius, robot.height});
    out.key("mast_h").number(look.mast).key("team_color").text(to_string(robot.team));
    out.key("teammate").truth(robot.team == me.team).key("keeper").truth(false);
    out.key("marker_z").numbers({look.marker_low, look.marker_high});
    add_visibility(out, view.robots[k]);
    out.close('}');
    ++number;
  }
  out.close(']');

  out.key("goals").open('{');
  for (const GoalColor color : {GoalColor::yellow, GoalColor::blue}) {
    const auto found = std::ranges::find(field_.goals, color, &FieldModel::Goal::color);
    const bool exists = found != field_.goals.end();
    const FieldExtent extent = field_extent(field_);
    const double x = exists ? mouth_x(field_, *found) : color == GoalColor::blue ? extent.x.high : extent.x.low;
    const FloorPoint middle = robot_from_field * FieldPoint{x, 0};
    out.key(to_string(color)).open('{').key("rx").number(middle.x).key("ry").number(middle.y);
    add_visibility(out, exists ? view.goals[static_cast<std::size_t>(found - field_.goals.begin())] : SimVisibility{});
    out.key("mouth_foot_px").open('[');
    for (const double sign : {1., -1.})
      out.maybe(exists ? pixel_in_image(robot_from_field * FieldPoint{x, sign * found->width / 2}) : std::nullopt);
    out.close(']').close('}');
  }
  out.close('}');

  out.key("free").open('{').key("robot").open('{');
  add_free(out, true_free_space(field_, state, observer, {0, 0}));
  out.close('}').key("camera").open('{');
  const FloorPoint foot{camera_.mount().x, camera_.mount().y};
  const TrueFreeSpace free = true_free_space(field_, state, observer, foot);
  add_free(out, free);
  const FieldPoint eye_at = field_from_robot * foot;
  const Point3<FieldFrame> eye{eye_at.x, eye_at.y, camera_.mount().z};
  std::array<std::optional<PixelPoint>, TrueFreeSpace::kSectors> feet;
  std::array<bool, TrueFreeSpace::kSectors> hidden{};
  for (std::size_t k = 0; k < free.ray.size(); ++k) {
    if (!free.ray[k]) continue;
    const double angle = radians(10. * static_cast<double>(k));
    const FloorPoint at = foot + *free.ray[k] * FloorPoint{std::cos(angle), std::sin(angle)};
    feet[k] = pixel_in_image(at);
    const FieldPoint in_field = field_from_robot * at;
    const Point3<FieldFrame> place{in_field.x, in_field.y, 0};
    hidden[k] = hides(ball, eye, place);
    int other = 0;
    for (const SimRobot& robot : state.robots) {
      if (robot.id == observer) continue;
      if (free.hit[k] != "robot" + std::to_string(other++)) hidden[k] = hidden[k] || hides(robot, eye, place);
    }
  }
  out.key("foot_px").open('[');
  for (const auto& p : feet) out.maybe(p);
  out.close(']').key("foot_hidden").open('[');
  for (std::size_t k = 0; k < feet.size(); ++k) feet[k] ? out.truth(hidden[k]) : out.null();
  out.close(']').close('}').close('}');

  out.key("light").open('{').key("mode").text(frame.light).key("lamps").open('[');
  for (const SimLamp& lamp : frame.lamps) out.number(lamp.intensity, 4);
  double warmth = 0, light = 0;  // of the lamps' light together
  for (const SimLamp& lamp : frame.lamps) {
    warmth += lamp.intensity * lamp.temperature;
    light += lamp.intensity;
  }
  out.close(']').key("T").number(light > 0 ? warmth / light : SimLamp{}.temperature, 0);
  out.key("ambient").number(frame.ambient, 4).close('}').close('}');
  return out.take();
}

}  // namespace tassilo
