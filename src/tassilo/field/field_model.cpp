#include "tassilo/field/field_model.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tassilo/base/error.h"

namespace tassilo {
namespace {

/// Longer than any hall; catches millimetres taken for metres. [m]
constexpr double kMaxLength = 200;

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream out;
  (out << ... << parts);
  return out.str();
}

[[noreturn]] void fail(const std::string& name, double value, const std::string& must) {
  throw Error("field." + name, text("is ", value, ", must be ", must));
}
void check_length(const std::string& name, double value) {
  if (!(value > 0 && value <= kMaxLength)) fail(name, value, text("> 0 and <= ", kMaxLength, " [m]"));
}
void check_length_or_none(const std::string& name, double value) {
  if (!(value >= 0 && value <= kMaxLength)) fail(name, value, text(">= 0 and <= ", kMaxLength, " [m]"));
}
void check_coordinate(const std::string& name, double value) {
  if (!(std::abs(value) <= kMaxLength)) fail(name, value, text("within +-", kMaxLength, " [m]"));
}
void check_ordered(const std::string& name, const Interval& interval) {
  if (!(interval.low <= interval.high))
    throw Error("field." + name, text("is [", interval.low, ", ", interval.high, "], must be [low, high]"));
}
void check_sizes(const std::string& name, const Interval& interval) {
  check_length(name + "[0]", interval.low);
  check_length(name + "[1]", interval.high);
  check_ordered(name, interval);
}
void check_faces(const std::string& name, const Interval& faces) {
  check_coordinate(name + "[0]", faces.low);
  check_coordinate(name + "[1]", faces.high);
  if (!(faces.low < faces.high))
    throw Error("field." + name, text("is [", faces.low, ", ", faces.high, "], must be [low, high] with low < high"));
}

void check_marks(const FieldModel& field) {
  for (std::size_t i = 0; i < field.areas.size(); ++i) {
    const std::string name = text("areas[", i, "]");
    check_length(name + ".depth", field.areas[i].depth);
    check_length(name + ".width", field.areas[i].width);
    if (field.areas[i].depth > field.length / 2)
      fail(name + ".depth", field.areas[i].depth, text("<= half the length, ", field.length / 2, " [m]"));
    if (field.areas[i].width > field.width)
      fail(name + ".width", field.areas[i].width, text("<= the width, ", field.width, " [m]"));
  }
  for (std::size_t i = 0; i < field.segments.size(); ++i) {
    const FieldModel::Segment& s = field.segments[i];
    const std::string name = text("segments[", i, "]");
    for (const double value : {s.x0, s.y0, s.x1, s.y1}) check_coordinate(name, value);
    if (s.x0 == s.x1 && s.y0 == s.y1) throw Error("field." + name, "is a point, must have two different ends");
  }
  for (std::size_t i = 0; i < field.arcs.size(); ++i) {
    const FieldModel::Arc& arc = field.arcs[i];
    const std::string name = text("arcs[", i, "]");
    for (const double value : {arc.cx, arc.cy}) check_coordinate(name + ".center", value);
    check_length(name + ".radius", arc.radius);
    for (const double angle : {arc.from, arc.to})
      if (!(std::abs(angle) <= 10)) fail(name + ".angle", angle, "within +-10 [rad]");
    if (!(arc.from < arc.to)) fail(name + ".from", arc.from, text("< to, ", arc.to, " [rad]"));
  }
}

void check_goals(const FieldModel& field) {
  for (std::size_t i = 0; i < field.goals.size(); ++i) {
    const FieldModel::Goal& goal = field.goals[i];
    const std::string name = text("goals[", i, "]");
    check_length(name + ".width", goal.width);
    check_length(name + ".height", goal.height);
    check_length_or_none(name + ".depth", goal.depth);
    if (goal.width > field.width)
      fail(name + ".width", goal.width, text("<= the field's width, ", field.width, " [m]"));
    for (std::size_t j = 0; j < i; ++j)
      if (field.goals[j].side == goal.side)
        throw Error("field." + name + ".side", text("is the side of goals[", j, "], each side has one goal at most"));
  }
}

}  // namespace

void FieldModel::check() const {
  check_length("length", length);
  check_length("width", width);
  check_length_or_none("line_width", line_width);
  if (line_width >= std::min(length, width) / 2) fail("line_width", line_width, "below half the field's size [m]");
  check_length_or_none("circle_radius", circle_radius);
  if (circle_radius > std::min(length, width) / 2)
    fail("circle_radius", circle_radius, text("<= half the field's size, ", std::min(length, width) / 2, " [m]"));
  check_marks(*this);
  check_goals(*this);
  if (walls) {
    check_length("walls.height", walls->height);
    check_faces("walls.x", walls->x);
    check_faces("walls.y", walls->y);
  }
  check_sizes("ball.radius", ball.radius);
  check_sizes("robots.width", robots.width);
  check_sizes("robots.height", robots.height);
}

}  // namespace tassilo
